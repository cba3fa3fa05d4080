//! `report`: a page from results of every kind, driven in Chromium; diagrams and tables as files; mistakes.

mod browser;
mod document;
mod verdict;

use lodray::report::diagram::{csv, diagrams, latex};
use lodray::report::error_time::{COSTS, ERRORS, ErrorTime, USUAL_COSTS, USUAL_ERRORS};
use lodray::report::page::{Documents, PICTURE_BYTES, embed, page, template};
use lodray_test_support::program::{Desk, FAILS, USAGE};
use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

fn empty() -> Desk {
    Desk::new(assert_cmd::cargo::cargo_bin!("lodray"))
}

/// Files by their paths.
type Files = Vec<(PathBuf, Vec<u8>)>;

/// A folder with a scene and its document. What is in it is made once for all tests.
fn desk() -> (Desk, ErrorTime) {
    static MADE: OnceLock<(Files, ErrorTime)> = OnceLock::new();
    let (files, document) = MADE.get_or_init(|| {
        let desk = empty();
        desk.run("generate terrain --levels 3 --base 8 --seed 2 -o a.lod");
        let document = document::of(&desk);
        (document::below(desk.folder(), Path::new("")), document)
    });
    let desk = empty();
    for (name, bytes) in files {
        let path = desk.folder().join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, bytes).unwrap();
    }
    (desk, document.clone())
}

#[test]
fn a_page_of_everything_works_in_a_browser() {
    let (desk, _) = desk();
    desk.write("jobs.toml", "size = \"16x16\"\ndistances = [1, 4]\nmethods = [\"lod\", \"bvh\"]\n[[scene]]\nfile = \"a.lod\"\n[[machine]]\nname = \"haydel2023\"\n");
    assert_eq!(desk.run_on(0, "sweep jobs.toml -o sweep").0, 0);
    desk.run("stability --case needles --rays 2000 --hunt 0 -o stability --quiet");
    desk.write("claims.md", "# Claims\n## Ledger\n| paper | measured |\n|---|---|\n| up to `20` times | 3 |\n");
    let said = desk.run("report error-time.json stability/stability.json claims.md -o page.html");
    assert!(said.starts_with("page in page.html, "), "{said}");
    let text = desk.text("page.html");
    // Nothing that a browser would fetch.
    assert!(!["src=\"http", "href=\"http", "url(http", "@import"].iter().any(|word| text.contains(word)));
    if let Some(found) = browser::drive(&desk.path("page.html"), Some(&desk.path("error-time.json"))) {
        println!("{:?}, ready after {} ms, {} bytes", found.counts, found.ready_ms, text.len());
        assert!(found.faults.is_empty(), "{:#?}", found.faults);
        for (what, least) in [("points", 300), ("diagrams", 20), ("cells", 30), ("axe_rules", 60), ("steps", 20)] {
            assert!(found.counts[what] >= least, "{what}: {}", found.counts[what]);
        }
    }
    // Simulations have fewer sections, and work as well.
    desk.run("report sweep/results.jsonl -o sweep.html --title plain");
    assert!(desk.text("sweep.html").contains("<title>plain</title>"));
    if let Some(found) = browser::drive(&desk.path("sweep.html"), Some(&desk.path("sweep/results.jsonl"))) {
        assert!(found.faults.is_empty(), "{:#?}", found.faults);
    }
}

#[test]
fn a_large_page_is_light_and_opens_soon() {
    let (desk, document) = desk();
    let large = document::enlarged(&document, desk.folder(), 3, 8, 512);
    let pictures = embed(&large.picture_files(desk.folder()), PICTURE_BYTES).unwrap();
    assert_eq!(pictures.len(), 3 * 8 * 16);
    let text = page(&Documents { title: "large".to_owned(), error_time: Some(large), pictures, ..Documents::default() }).unwrap();
    assert!(text.len() < 10_000_000, "{} bytes", text.len());
    desk.write("large.html", &text);
    if let Some(found) = browser::drive(&desk.path("large.html"), None) {
        println!("{} bytes, ready after {} ms", text.len(), found.ready_ms);
        assert!(found.faults.is_empty(), "{:#?}", found.faults);
        // Under two seconds on a quiet machine; other tests run beside this one.
        assert!(found.ready_ms < 10_000.0, "ready after {} ms", found.ready_ms);
    }
}

#[test]
fn the_same_results_give_the_same_page_and_other_commands_write_theirs() {
    let (desk, document) = desk();
    // The command's own page has the run itself in it, and nothing else besides.
    assert!(desk.text("report.html").contains("Error against cost: terrain") || desk.text("report.html").contains("Error against cost: a"));
    assert_eq!(document, serde_json::from_str(&desk.text("error-time.json")).unwrap());
    for name in ["a.html", "b.html"] {
        desk.run(&format!("report error-time.json -o {name} --quiet"));
    }
    assert!(desk.bytes("a.html") == desk.bytes("b.html"));
    desk.run("simulate a.lod --size 16x16 --report simulate.html -o run --quiet");
    assert!(
        desk.text("simulate.html").contains("<title>Simulations: a</title>")
            || desk.text("simulate.html").contains("<title>Simulations: terrain</title>")
    );
    // The page is beside the run: its folder does not know of it.
    assert!(!desk.text("run/run.json").contains("html"));
    desk.run("report run/result.json -o result.html --quiet");
    desk.run("stability --case needles --rays 500 --hunt 0 --report stability.html --quiet");
    assert!(desk.text("stability.html").contains("<title>Stability</title>"));
}

#[test]
fn views_that_were_measured_apart_stand_on_one_page() {
    let (desk, whole) = desk();
    let mut apart = document::by_view(&whole);
    assert_eq!(apart.len(), 3);
    // Machines stand elsewhere in a document of others, and methods in another order.
    let mut second = apart[1].clone();
    second.machines.insert(0, lodray::report::result::MachineFacts { label: "another".to_owned(), ..whole.machines[0].clone() });
    document::costs(&mut second).for_each(|costs| costs.machine += 1);
    second.equal_error.iter_mut().for_each(|equal| equal.machine += 1);
    second.methods.reverse();
    let join = |a: &ErrorTime, b: &ErrorTime| a.clone().join(b.clone());
    let mut joined = join(&join(&apart[0], &second).unwrap(), &apart[2]).unwrap();
    assert_eq!(joined.machines.pop().unwrap().label, "another");
    assert_eq!(joined, whole);
    joined.check().unwrap();
    // A scene and a method of its own.
    second.scenes[0].name = "another".to_owned();
    second.methods[0].name = "another".to_owned();
    let two = join(&apart[0], &second).unwrap();
    assert_eq!((two.scenes.len(), two.views[1].scene, two.methods.len()), (2, 1, whole.methods.len() + 1));
    two.check().unwrap();
    // As files, in any folders, with pictures of the same names; each has frames of other sizes.
    let sizes = apart.iter().find(|document| !document.sizes.is_empty()).unwrap().sizes.clone();
    for (k, document) in apart.iter_mut().enumerate() {
        std::fs::create_dir(desk.path(&format!("view-{k}"))).unwrap();
        for (n, picture) in document.pictures.iter_mut().enumerate() {
            let file = format!("{n}.png");
            std::fs::copy(desk.path(&picture.file), desk.path(&format!("view-{k}/{file}"))).unwrap();
            picture.file = file;
        }
        document.sizes.clone_from(&sizes);
        let costs = document.sizes.iter_mut().filter(|size| size.method == "lod").flat_map(|size| &mut size.costs);
        costs.for_each(|costs| costs.milliseconds *= 1.0 + k as f64);
        desk.write(&format!("view-{k}/error-time.json"), &serde_json::to_string(document).unwrap());
    }
    let all = join(&join(&apart[0], &apart[1]).unwrap(), &apart[2]).unwrap();
    desk.write("all.json", &serde_json::to_string(&all).unwrap());
    desk.run("report view-0/error-time.json view-1/error-time.json view-2/error-time.json -o apart.html --quiet");
    desk.run("report error-time.json -o whole.html --quiet");
    let pictures = |page: &str| -> Vec<String> {
        let blocks = desk.text(page);
        let blocks = blocks.split("<script type=\"text/plain\" id=\"picture-").skip(1);
        blocks.map(|block| block.split_once("</script>").unwrap().0.to_owned()).collect()
    };
    assert!(pictures("apart.html").len() == whole.pictures.len() && pictures("apart.html") == pictures("whole.html"));
    if let Some(found) = browser::drive(&desk.path("apart.html"), Some(&desk.path("all.json"))) {
        assert!(found.faults.is_empty(), "{:#?}", found.faults);
        assert!(found.counts["points"] >= 300);
    }
    // What does not go together is refused by name, and other figures of the program are said.
    let refused = |change: &dyn Fn(&mut ErrorTime), why: &str| {
        let mut other = apart[1].clone();
        change(&mut other);
        let said = join(&apart[0], &other).unwrap_err();
        assert!(said.contains(why), "{said}");
    };
    refused(&|d| d.options.samples.push(64), "options.samples is [1,4,64], and [1,4] in a file before it");
    refused(&|d| d.scenes[0].hash = "0".to_owned(), "is another than in a file before it");
    refused(&|d| d.machines[0].description.cores.clock_mhz *= 2, "machine haydel2023 is another");
    refused(&|d| d.methods[0].knob = Some("none".to_owned()), "is another than in a file before it");
    refused(&|d| d.views[0].distance = apart[0].views[0].distance, "radii is in a file before it, too");
    let other = ErrorTime { program: "lodray 0".to_owned(), ..apart[1].clone() };
    desk.write("view-1/error-time.json", &serde_json::to_string(&other).unwrap());
    let said = desk.run("report view-0/error-time.json view-1/error-time.json -o apart.html");
    assert!(said.contains("several versions stand side by side") && said.contains(" and lodray 0"), "{said}");
}

#[test]
fn frames_after_one_another_stand_one_by_one() {
    let (desk, _) = desk();
    desk.run("simulate a.lod --size 32x32 --frames 4 --turn 20 --report frames.html -o frames --quiet");
    if let Some(found) = browser::drive(&desk.path("frames.html"), Some(&desk.path("frames/result.json"))) {
        assert!(found.faults.is_empty(), "{:#?}", found.faults);
        assert!(found.counts["points"] >= 20);
    }
}

#[test]
fn a_command_of_the_inspector_follows_its_ray() {
    let (desk, document) = desk();
    let grid = document.traces.iter().find(|grid| grid.method == "lod" && grid.view == 1).unwrap();
    let command = grid.command.as_ref().unwrap().strip_prefix("lodray ").unwrap();
    let mut followed = 0;
    for ray in grid.rays.iter().filter(|ray| ray.hit.is_some()).step_by(4) {
        let [x, y] = ray.pixel;
        let text = desk.run(&format!("{command} {x},{y}"));
        // Edge states in their order, lines, triangles tested.
        let edges = |line: &str| {
            let (node, rest) = line.split_once("level ")?.1.split_once(": edge states ")?;
            let (level, node) = node.split_once(" node ")?;
            let (states, decision) = rest.split_once(" of 256: ")?;
            Some(if decision == "refine" { format!("r{level}.{node}:{}", states.replace(' ', ".")) } else { format!("s{level}.{node}") })
        };
        let told: Vec<_> = text.lines().filter_map(edges).collect();
        let words: Vec<_> = ray.steps.split(' ').map(|word| word.trim_start_matches('*')).collect();
        let kept: Vec<_> =
            words.iter().filter(|word| word.starts_with(['r', 's'])).map(|word| word.split('@').next().unwrap().to_owned()).collect();
        assert_eq!(told, kept, "pixel {x},{y}");
        let lines: u64 = words.iter().filter_map(|word| word.split_once('@')?.1.rsplit('.').next()?.parse::<u64>().ok()).sum();
        assert_eq!(lines, text.matches("  read line ").count() as u64, "pixel {x},{y}");
        let triangles: u64 = words.iter().filter_map(|word| word.strip_prefix('x')?.split(':').next()?.parse::<u64>().ok()).sum();
        assert_eq!(triangles, text.lines().filter(|line| line.contains("  triangle level ")).count() as u64, "pixel {x},{y}");
        followed += told.len();
    }
    println!("{followed} LOD tests");
    assert!(followed > 10);
}

#[test]
fn diagrams_and_tables_are_files_that_others_read() {
    let (_, document) = desk();
    let files = diagrams(&document, &USUAL_ERRORS[..1], &USUAL_COSTS[..1]).unwrap();
    assert_eq!(files, diagrams(&document, &USUAL_ERRORS[..1], &USUAL_COSTS[..1]).unwrap());
    let names: HashSet<_> = files.iter().map(|file| file.0.as_str()).collect();
    assert_eq!(names.len(), files.len());
    for (name, bytes) in &files {
        if name.ends_with(".png") {
            let picture = image::load_from_memory(bytes).unwrap().to_rgb8();
            assert!(picture.width() > 500 && picture.pixels().collect::<HashSet<_>>().len() > 20, "{name}");
        } else {
            assert!(name.ends_with(".svg") && bytes.starts_with(b"<svg") && bytes.ends_with(b"</svg>\n"), "{name}");
        }
    }
    let time = files.iter().find(|file| file.0.ends_with("distance-time-haydel2023-free.svg")).unwrap();
    assert!(std::str::from_utf8(&time.1).unwrap().contains('\u{d7}'));
    if let Some(folder) = std::env::var_os("LODRAY_SCREENSHOTS") {
        for (name, bytes) in diagrams(&document, &USUAL_ERRORS, &USUAL_COSTS).unwrap() {
            std::fs::write(Path::new(&folder).join(name), bytes).unwrap();
        }
    }
    let table = csv(&document);
    assert_eq!(table.lines().count(), 1 + document.points.iter().map(|p| p.costs.len()).sum::<usize>());
    assert_eq!(table.lines().next().unwrap().split(',').count(), 8 + ERRORS.len() + COSTS.len());
    let tex = latex(&document);
    assert!(tex.contains("\\toprule") && tex.matches("\\begin{tabular}").count() == tex.matches("\\end{tabular}").count());
}

#[test]
fn the_verdict_names_the_winner_ours_or_not() {
    verdict::names_the_winner_ours_or_not(&desk().1);
}

/// What docs/report.md says where its screenshots are older than the page; `scripts/gallery` takes it away.
const OLDER: &str = "The screenshots are of an older page.";

#[test]
fn screenshots_are_of_this_page_or_the_document_says_that_they_are_older() {
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs");
    let read = |name: &str| std::fs::read_to_string(docs.join(name)).unwrap();
    let made: serde_json::Value = serde_json::from_str(&read("images/report.json")).unwrap();
    let claims = format!("{:016x}", xxhash_rust::xxh3::xxh3_64(read("claims.md").as_bytes()));
    let is_new = made["template"] == template() && made["documents"]["claims.md"] == claims.as_str();
    let says_older = read("report.md").lines().any(|line| line == OLDER);
    assert!(is_new || says_older, "run scripts/gallery, or let docs/report.md say: {OLDER}");
    assert!(!(is_new && says_older), "docs/report.md says that its screenshots are older than they are");
    for picture in read("report.md").split("images/").skip(1).filter_map(|rest| rest.split_once(')')) {
        assert!(docs.join("images").join(picture.0).exists(), "{}", picture.0);
    }
}

#[test]
fn mistakes_are_named_with_file_and_field() {
    let (desk, document) = desk();
    let whole = desk.text("error-time.json");
    desk.refused("report gone.json -o p.html", FAILS, &["cannot read gone.json"]);
    desk.write("words.json", "rubbish");
    desk.refused("report words.json -o p.html", FAILS, &["words.json", "it is not JSON"]);
    desk.write("short.json", &whole.replacen("\"views\"", "\"wiews\"", 1));
    desk.refused("report short.json -o p.html", FAILS, &["short.json", "the field views is missing"]);
    let other = |change: &dyn Fn(&mut ErrorTime)| {
        let mut changed = document.clone();
        change(&mut changed);
        desk.write("other.json", &serde_json::to_string(&changed).unwrap());
    };
    other(&|d| d.points[2].view = 99);
    desk.refused("report other.json -o p.html", FAILS, &["other.json", "points[2].view is 99, and there are 3 views"]);
    other(&|d| d.version = 9);
    desk.refused("report other.json -o p.html", FAILS, &["other.json", "version is 9"]);
    other(&|d| d.pictures[0].file = "pictures/none.png".to_owned());
    desk.refused("report other.json -o p.html", FAILS, &["other.json", "pictures/none.png"]);
    desk.write("empty.md", "nothing\n");
    desk.refused("report empty.md -o p.html", FAILS, &["empty.md: there is no table in it"]);
    desk.write("stable.json", "{\"widths_checked\": true}");
    desk.refused("report stable.json -o p.html", FAILS, &["stable.json", "the field seed is missing"]);
    desk.refused("report error-time.json error-time.json -o p.html", FAILS, &["error-time.json: scene ", "is in a file before it, too"]);
    desk.refused("report error-time.json -o error-time.json", FAILS, &["error-time.json"]);
    desk.refused("report -o p.html", USAGE, &["RESULT"]);
    assert!(!desk.path("p.html").exists());
    assert_eq!(desk.text("error-time.json"), whole);
}
