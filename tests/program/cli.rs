//! Every subcommand end to end, as a user types it.

use lodray_test_support::program::Desk;
use serde_json::Value;
use std::fs;

/// An empty folder to run the program in.
fn empty() -> Desk {
    Desk::new(assert_cmd::cargo::cargo_bin!("lodray"))
}

/// A bumpy square of 2 n^2 triangles.
fn sheet(n: u32) -> String {
    let mut text = String::new();
    for (y, x) in (0..=n).flat_map(|y| (0..=n).map(move |x| (y, x))) {
        let (x, y) = (f64::from(x) / f64::from(n), f64::from(y) / f64::from(n));
        text += &format!("v {x} {} {y}\n", 0.1 * (7.0 * x).sin() * (5.0 * y).cos());
    }
    for (y, x) in (0..n).flat_map(|y| (0..n).map(move |x| (y, x))) {
        let a = y * (n + 1) + x + 1;
        let (b, c, d) = (a + 1, a + n + 1, a + n + 2);
        text += &format!("f {a} {c} {b}\nf {b} {c} {d}\n");
    }
    text
}

#[test]
fn generate_and_info() {
    let desk = empty();
    for (name, base) in [("terrain", 32), ("cloth", 32), ("sphere", 32), ("spikes", 32), ("room", 42), ("pot", 64), ("drape", 32)] {
        let made = desk.json(&format!("generate {name} --levels 2 --base {base} --seed 3 -o {name}.lod"));
        assert_eq!(made["name"], name);
        assert_eq!(made, desk.json(&format!("info {name}.lod")));
        assert_eq!(made["finest_triangles"].as_u64().unwrap(), made["base_triangles"].as_u64().unwrap() * 16);
        assert_eq!((&made["levels"], &made["origin"]["generate"]["seed"]), (&2.into(), &3.into()));
    }
    let info = desk.json("info sphere.lod");
    let bytes: u64 = info["parts"].as_array().unwrap().iter().map(|p| p["bytes"].as_u64().unwrap()).sum();
    let whole = fs::metadata(desk.path("sphere.lod")).unwrap().len();
    assert!(bytes < whole && bytes > whole / 2);
    let (short, all) = (desk.run("info sphere.lod"), desk.run("info sphere.lod --verbose"));
    for word in ["512 at full resolution: 32 base triangles, each split 2 times into 4", " MB, ", "width x height x depth"] {
        assert!(short.contains(word) && all.contains(word), "{word} in {short}{all}");
    }
    for word in ["per finest triangle", "L0 records", "generate.seed: 3"] {
        assert!(all.contains(word) && !short.contains(word), "{word} in {short}{all}");
    }
    assert!(short.lines().count() <= 6 && !short.contains("warning"), "{short}");
    assert_eq!(info["bytes"], whole);
    // Nine levels leave base vertices fewer bits than single precision has; that is told even to those who want quiet.
    let said = desk.run("generate sphere --levels 9 --base 8 -o deep.lod");
    assert!(said.starts_with("deep.lod:\nscene ") && said.contains("\nwarning     base vertices are rounded to steps of"), "{said}");
    let (code, said) = desk.hear("generate sphere --levels 9 --base 8 -o deep.lod --quiet");
    assert!(code == 0 && said.starts_with("warning: deep.lod: base vertices") && said.lines().count() == 1, "{said}");
    assert_eq!(desk.run("generate sphere --levels 2 --base 8 -o plain.lod --quiet"), "");
}

#[test]
fn loop_surfaces_of_meshes() {
    let desk = empty();
    fs::write(desk.path("sheet.obj"), sheet(6)).unwrap();
    let made = desk.json("build sheet.obj --subdivide loop --levels 4 -o sheet.lod");
    assert_eq!((&made["name"], &made["levels"], &made["base_triangles"]), (&"sheet".into(), &4.into(), &72.into()));
    assert_eq!(made["origin"]["subdivide"], serde_json::json!({ "rule": "loop", "levels": 4 }));
    assert_eq!(made["origin"]["mesh"]["triangles_read"], 72);
    // It was not built from that mesh: a BVH over it would hold another surface.
    assert!(made["origin"]["file"].is_null());
    assert!(desk.run("verify sheet.lod").ends_with("passed\n"));
    for threads in [1, 2, 3] {
        desk.run(&format!("build sheet.obj --subdivide loop --levels 4 --threads {threads} -o again.lod"));
        assert!(fs::read(desk.path("again.lod")).unwrap() == fs::read(desk.path("sheet.lod")).unwrap(), "{threads} threads");
    }
    desk.refused(
        "build sheet.obj --subdivide loop --crease-angle 30 -o no.lod",
        1,
        &["--crease-angle: loop and catmull-clark have no creases"],
    );
    // Levels and forms as those of other scenes.
    assert_eq!(desk.json("build sheet.obj --subdivide loop -o default.lod")["levels"], 3);
    let exact = desk.json("build sheet.obj --subdivide loop --levels 2 --vertices exact --coordinate-zeros 4 -o exact.lod");
    assert_eq!((&exact["vertices"], &exact["levels"]), (&"exact".into(), &2.into()));
    // What the surface does not keep is said, or refused.
    fs::write(desk.path("shaded.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 3//1\n").unwrap();
    let (code, said) = desk.hear("build shaded.obj --subdivide loop -o shaded.lod --quiet");
    assert!(code == 0 && said == "warning: shaded.obj: its shading normals are not kept: the subdivided surface has its own\n", "{said}");
    let (code, said) = desk.hear("build shaded.obj --subdivide loop --strict -o none.lod");
    assert!(code == 1 && said.starts_with("error: shaded.obj: its shading normals") && !desk.path("none.lod").exists(), "{said}");
    // A seam is said with what closes it, and closed.
    fs::write(desk.path("seam.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 0 1e-6\nv 0 1 1e-6\nv 1 1 0\nf 1 2 3\nf 4 6 5\n").unwrap();
    let (_, said) = desk.hear("build seam.obj --subdivide loop -o seam.lod --quiet");
    assert!(said.contains("open edges are seams: --weld "), "{said}");
    assert_eq!(desk.json("build seam.obj --subdivide loop --weld 1e-5 -o seam.lod")["base_vertices"], 4);
}

#[test]
fn displacement_maps_over_meshes() {
    let desk = empty();
    // A quad that a picture of 8 x 8 heights, a ramp from left to right, is laid over.
    fs::write(desk.path("quad.obj"), "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n").unwrap();
    let ramp = image::ImageBuffer::from_fn(8, 8, |x, _| image::Luma([x as u16 * 9362]));
    image::DynamicImage::ImageLuma16(ramp).save(desk.path("ramp.png")).unwrap();
    // Without --levels a point for each texel.
    let made = desk.json("build quad.obj --displace ramp.png --amount 0.5 --middle 0.25 -o ramp.lod");
    assert_eq!((&made["levels"], &made["base_triangles"]), (&3.into(), &2.into()));
    let told = &made["origin"]["subdivide"];
    assert_eq!(
        (&told["rule"], &told["displace"]["map"], &told["displace"]["size"]),
        (&"flat".into(), &"ramp.png".into(), &vec![8, 8].into())
    );
    let moved = |what: &str| told["displace"]["moved"][what].as_f64().unwrap();
    assert!((moved("least") + 0.125).abs() < 0.04 && (moved("most") - 0.375).abs() < 0.04 && moved("seam_points") == 0.0, "{told}");
    assert!(desk.run("verify ramp.lod").ends_with("passed\n"));
    // Over a smooth surface too, the same at any number of threads.
    desk.run("build quad.obj --subdivide catmull-clark --displace ramp.png --amount 0.1 --levels 4 -o smooth.lod");
    for threads in [1, 3] {
        desk.run(&format!(
            "build quad.obj --subdivide catmull-clark --displace ramp.png --amount 0.1 --levels 4 --threads {threads} -o again.lod"
        ));
        assert!(fs::read(desk.path("again.lod")).unwrap() == fs::read(desk.path("smooth.lod")).unwrap(), "{threads} threads");
    }
    assert!(desk.run("verify smooth.lod").ends_with("passed\n"));
    // A mesh without texture coordinates has no place on a map.
    fs::write(desk.path("bare.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
    let (code, said) = desk.hear("build bare.obj --displace ramp.png --amount 1 -o none.lod");
    assert!(
        code == 1 && said == "error: bare.obj: it has no texture coordinates, which say where on a displacement map it lies\n",
        "{said}"
    );
    let (code, said) = desk.hear("build quad.obj --displace ramp.png --amount 1 -o ramp.png");
    assert!(code == 1 && said.contains("it is the input file") && !desk.path("none.lod").exists(), "{said}");
}

#[test]
fn displacement_bounds_are_named_wherever_a_scene_is_told_of() {
    let desk = empty();
    for kind in ["largest", "total"] {
        let made = desk.json(&format!("generate terrain --levels 3 --base 8 --bounds {kind} -o {kind}.lod"));
        assert_eq!((&made["bounds"], &desk.json(&format!("verify {kind}.lod"))["bounds"]), (&kind.into(), &kind.into()));
        assert!(desk.run(&format!("info {kind}.lod")).contains(&format!("\nbounds      {kind}: delta 1")));
        let said = desk.run(&format!("verify {kind}.lod"));
        assert!(said.starts_with(&format!("displacement bounds: {kind}\n")) && said.ends_with("passed\n"), "{said}");
    }
    // Without a word the default, which the help names.
    let plain = desk.json("generate terrain --levels 3 --base 8 -o plain.lod");
    let default = plain["bounds"].as_str().unwrap();
    assert!(desk.run("generate --help").contains(&format!("[default: {default}]")));
    assert_eq!(fs::read(desk.path("plain.lod")).unwrap(), fs::read(desk.path(&format!("{default}.lod"))).unwrap());
}

#[test]
fn build_tells_how_far_it_is_from_the_original() {
    let desk = empty();
    fs::write(desk.path("sheet.obj"), sheet(24)).unwrap();
    let made = desk.json("build sheet.obj -o sheet.lod --levels 3 --base 40");
    assert_eq!((&made["name"], &made["levels"]), (&"sheet".into(), &3.into()));
    // Compact vertices add what they were moved by: percent of a diagonal of 1.4 to 1.5.
    let moved = 100.0 * made["moved"].as_f64().unwrap();
    for way in ["to_original", "from_original"] {
        let before = made["origin"]["remesh"]["distance"][way]["max"].as_f64().unwrap();
        let more = made["distance"][way]["max"].as_f64().unwrap() - before;
        assert!(moved / 1.5 <= more && more <= moved / 1.4 && more > 0.0, "{way}: {more} of {moved}");
        let (mean, max) = (made["distance"][way]["mean"].as_f64().unwrap(), made["distance"][way]["max"].as_f64().unwrap());
        assert!(0.0 < mean && mean < max && max < 5.0, "{way}: {mean} {max}");
    }
    let text = desk.run("info sheet.lod --verbose");
    assert!(text.contains("distance to the original mesh: mean 0.") && text.contains("of the diagonal; from it back: mean 0."), "{text}");
    let text = desk.run("info sheet.lod");
    assert!(text.contains("\naccuracy    0.") && text.contains("of the model's diagonal from the original mesh on average"), "{text}");
    assert!(text.contains("\nmodel size  1 x 0.1"), "{text}");
    assert!(desk.run("verify sheet.lod").ends_with("passed\n"));
}

#[test]
fn verify_counts_and_fails() {
    let desk = empty();
    desk.run("generate terrain --levels 3 --base 32 -o a.lod");
    let text = desk.run("verify a.lod");
    assert!(text.contains("checked") && text.contains("expected") && text.ends_with("passed\n"));
    let report = desk.json("verify a.lod");
    for check in report["checks"].as_array().unwrap() {
        assert_eq!(check["checked"], check["expected"], "{check}");
        assert_eq!(check["breaches"], 0, "{check}");
    }

    // Every section is under a checksum: a flipped bit anywhere but in the padding is noticed, and named.
    let good = fs::read(desk.path("a.lod")).unwrap();
    for place in [1, 100, good.len() / 3, good.len() / 2, good.len() - 65] {
        let mut bad = good.clone();
        bad[place] ^= 4;
        fs::write(desk.path("bad.lod"), bad).unwrap();
        let (code, text) = desk.hear("verify bad.lod");
        assert_eq!(code, 1, "byte {place}: {text}");
        assert!(text.starts_with("error: bad.lod: ") && text.lines().count() == 1, "{text}");
    }
}

#[test]
fn render_with_every_method() {
    let desk = empty();
    desk.run("generate sphere --levels 3 --base 32 -o a.lod");
    for method in ["lod", "bvh", "bvh6", "bvh32", "reference"] {
        let report = desk.json(&format!("render a.lod --method {method} --size 40x24 --distance 3 --compare -o {method}"));
        assert_eq!((&report["method"], &report["stats"]["rays"]), (&method.into(), &960.into()));
        assert!(report["stats"]["hits"].as_u64().unwrap() > 50);
        for time in ["building", "tracing"] {
            assert!(report["seconds"][time].as_f64().is_some_and(|seconds| seconds >= 0.0), "{time}: {report}");
        }
        let rmse = report["error"]["rmse"].as_f64().unwrap();
        let limit = if method == "lod" { 40.0 } else { 2.0 };
        assert!(rmse <= limit, "{method}: {rmse}");
        assert!(report["error"]["maximum"].is_u64() && report["error"]["differing"].is_f64(), "{report}");
        assert_eq!(report["stats"]["lines"].as_array().unwrap().is_empty(), method == "reference");
        let names: Vec<String> = desk.files(method).into_keys().collect();
        assert_eq!(names, ["error.png", "image.png", "levels.png", "normals.png", "run.json", "sheet.png"]);
        assert_eq!(image::image_dimensions(desk.path(method).join("image.png")).unwrap(), (40, 24));
    }
    // The reference differs from itself nowhere, and its error map is black.
    assert!(image::open(desk.path("reference/error.png")).unwrap().crop(0, 0, 40, 24).to_rgb8().pixels().all(|p| p.0 == [0; 3]));

    let text = desk.run("render a.lod --eye 0,0,-4 --target 0,0,0 --up 0,1,0 --fov 30 --delta inf --size 8x8 -o far/away");
    assert!(text.contains("64 rays") && text.contains("pictures in far/away"), "{text}");
    assert_eq!(desk.files("far/away").len(), 5);
}

#[test]
fn lines_by_distance() {
    let desk = empty();
    desk.run("generate terrain --levels 3 --base 32 -o a.lod");
    let report = desk.json("lines a.lod --distances 1.5,6 --size 32x32 --all");
    assert_eq!(report["distances"], serde_json::json!([1.5, 6.0]));
    assert_eq!(report["rows"].as_array().unwrap().len(), 2 + 48);
    for field in ["ratio", "base_share", "mean_level"] {
        assert_eq!(report[field].as_array().unwrap().len(), 2, "{field}");
    }
    assert!(desk.run("lines a.lod --distances 4 --size 8x8").contains("best BVH / LOD"));
}

#[test]
fn crack_needs_a_closed_model() {
    let desk = empty();
    desk.run("generate sphere --levels 2 --base 32 -o closed.lod");
    desk.run("generate terrain --levels 2 --base 32 -o open.lod");
    let report = desk.json("crack closed.lod --rays 3000 --seed 5");
    assert_eq!(report["rows"].as_array().unwrap().iter().map(|r| r["rays"].as_u64().unwrap()).sum::<u64>(), 3000);
    assert!(desk.run("crack closed.lod --rays 300").contains("0 misses or double hits in 300 rays"));
    let (code, text) = desk.hear("crack open.lod --rays 300");
    assert_eq!(code, 1);
    assert!(text.starts_with("error: open.lod: ") && text.contains("open borders"), "{text}");
}

#[test]
fn export_is_read_again() {
    let desk = empty();
    desk.run("generate sphere --levels 3 --base 32 -o a.lod");
    for (level, option) in [(0u32, "--level 0"), (2, "--level 2"), (3, "")] {
        // A closed surface without handles: V = F / 2 + 2.
        let faces = 32usize << (2 * level);
        let said = desk.run(&format!("export a.lod {option} -o a.obj"));
        assert!(said.starts_with("a.obj: "), "{said}");
        let mesh = lodray::mesh::read(&desk.path("a.obj")).unwrap();
        assert_eq!((mesh.triangles.len(), mesh.positions.len()), (faces, faces / 2 + 2));
    }
    assert_eq!(desk.files(".").len(), 2, "left-over files");
}

#[test]
fn demo_compares_four_methods_at_three_distances_on_a_sheet_and_a_page() {
    let desk = empty();
    let rows: Value = desk.json("demo --out new/demo");
    let rows = rows.as_array().unwrap();
    let number = |row: &Value, key: &str| row[key].as_f64().unwrap();
    for view in ["near", "middle", "far"] {
        let of = |begin: &str| rows.iter().find(|row| row["view"] == view && row["method"].as_str().unwrap().starts_with(begin));
        let [ours, bvh, rule] = ["ours, delta 1", "best BVH (bvh", "discrete, own rule (level"].map(|begin| of(begin).unwrap());
        // What there is to see: ours reads less than full resolution, has fewer bytes, and an error below what delta promises.
        assert!(
            number(ours, "dram_bytes") < number(bvh, "dram_bytes")
                && number(ours, "bytes_per_triangle") < number(bvh, "bytes_per_triangle")
        );
        assert!(number(bvh, "error_pixels") < 0.01 && number(ours, "error_pixels") < 1.5 && number(rule, "microseconds") > 0.0);
        if let Some(hindsight) = of("discrete, hindsight (level") {
            assert!(number(hindsight, "error_pixels") <= number(ours, "error_pixels"));
        }
    }
    let names: Vec<String> = desk.files("new/demo").into_keys().collect();
    assert_eq!(names, ["report.html", "run.json", "sheet.png", "table.txt"]);
    // One sentence, and what a unit for the views leaves out.
    let table = desk.text("new/demo/table.txt");
    assert!(
        table.contains("Near / middle / far, times over ours: the best BVH ") && table.contains("their rays go down to level"),
        "{table}"
    );
    assert!(table.contains("a traversal unit for these views needs 5 of 10 levels") && table.contains(" gate equivalents, "), "{table}");
    assert!(image::image_dimensions(desk.path("new/demo/sheet.png")).unwrap().0 > 900);
}

#[test]
fn any_number_of_threads_gives_the_same_bytes() {
    let outputs = [0, 1, 3].map(|threads| {
        let desk = empty();
        fs::write(desk.path("sheet.obj"), sheet(20)).unwrap();
        let commands = [
            "generate sphere --levels 3 --base 32 -o sphere.lod --json",
            "generate spikes --levels 2 --base 32 -o spikes.lod",
            "build sheet.obj -o sheet.lod --levels 2 --max-error 1 --json",
            "verify sheet.lod",
            "verify sphere.lod --json",
            "render sphere.lod --size 48x48 --compare -o a --json",
            "render sheet.lod --method bvh --size 48x48 --compare -o b --json",
            "lines sheet.lod --distances 2,8 --size 48x48",
            "crack sphere.lod --rays 2000",
            "export sheet.lod -o sheet2.obj",
        ];
        let said = commands.map(|args| {
            let (code, out, err) = desk.run_on(threads, args);
            // Times are not the same in two runs.
            let is_time = |line: &&str| ["building", "tracing"].iter().any(|name| line.trim().starts_with(&format!("\"{name}\":")));
            (code, out.lines().filter(|line| !is_time(line)).collect::<Vec<_>>().join("\n"), err)
        });
        let pictures = [desk.files("a"), desk.files("b")];
        fs::remove_dir_all(desk.path("a")).unwrap();
        fs::remove_dir_all(desk.path("b")).unwrap();
        (said, pictures, desk.files("."))
    });
    assert!(outputs[0].0.iter().all(|(code, _, err)| *code == 0 && err.is_empty()));
    for other in &outputs[1..] {
        assert_eq!(other.0, outputs[0].0);
        assert!(other.1 == outputs[0].1, "pictures differ");
        assert!(other.2 == outputs[0].2, "files differ");
    }
}

#[test]
fn threads_and_quiet_go_with_every_command() {
    let desk = empty();
    desk.run("generate sphere --levels 2 --base 32 -o a.lod");
    fs::write(desk.path("sheet.obj"), sheet(8)).unwrap();
    desk.run("simulate a.lod --size 8x8 -o sim --quiet");
    fs::write(
        desk.path("jobs.toml"),
        "size = \"8x8\"\ndistances = [2]\nmethods = [\"lod\"]\n[[scene]]\nfile = \"a.lod\"\n[[machine]]\nname = \"packet\"\n",
    )
    .unwrap();
    // Each with what is left of its output, if anything.
    for (args, says) in [
        ("generate sphere --levels 1 --base 8 -o b.lod", ""),
        ("build sheet.obj -o sheet.lod --levels 1 --max-error 2", ""),
        ("export a.lod -o a.obj", ""),
        ("sweep jobs.toml -o sweep", ""),
        ("trace a.lod --pixel 4,4 --size 8x8 -o a.vcd", ""),
        ("info a.lod", "scene "),
        ("verify a.lod", "passed"),
        ("render a.lod --size 8x8 -o r", "64 rays"),
        ("simulate a.lod --size 8x8 -o sim", "hit rate"),
        ("compare sim/result.json sim/result.json", "1.000"),
        ("lines a.lod --distances 2 --size 8x8", "mean level"),
        ("crack a.lod --rays 100", "0 misses or double hits"),
        ("stability --case flat --rays 1000", "0 breaches"),
    ] {
        let loud = desk.run(args);
        let quiet = desk.run(&format!("{args} --quiet --threads 2"));
        assert!(if says.is_empty() { quiet.is_empty() && !loud.is_empty() } else { quiet.contains(says) }, "{args}: {quiet}");
        assert!(!quiet.contains(" in r") && !quiet.contains(" in sim"), "{args}: {quiet}");
        for bad in ["0", "-1", "1025", "many"] {
            let (code, text) = desk.hear(&format!("--threads {bad} {args}"));
            assert!(code == 2 && text.contains(&format!("'{bad}' is not a whole number from 1 to 1024")), "{args}: {text}");
        }
    }
}

#[test]
fn refusals_name_option_value_and_limit() {
    let desk = empty();
    desk.run("generate sphere --levels 2 --base 32 -o a.lod");
    let seeds = "'-1' is not a whole number from 0 to 18446744073709551615";
    let rays = "'0' is not a whole number from 1 to 1000000000000000";
    for (args, option, limit) in [
        ("generate sphere -o b.lod --seed -1", "--seed", seeds),
        ("crack a.lod --seed -1", "--seed", seeds),
        ("stability --seed -1", "--seed", seeds),
        ("crack a.lod --rays 0", "--rays", rays),
        ("stability --rays 0", "--rays", rays),
        ("stability --hunt -1", "--hunt", "'-1' is not a whole number from 0 to 1000000000000000"),
        ("generate sphere -o b.lod --levels 11", "--levels", "'11' is not a whole number from 0 to 10"),
        ("generate sphere -o b.lod --base 0", "--base", "'0' is not a whole number from 1 to 134217728"),
        ("generate sphere -o b.lod --roughness 2", "--roughness", "'2' is not between 0 and 1"),
        ("build a.obj -o b.lod --levels 11", "--levels", "'11' is not a whole number from 0 to 10"),
        ("build a.obj -o b.lod --base 0", "--base", "'0' is not a whole number from 1 to"),
        ("build a.obj -o b.lod --max-error 0", "--max-error", "'0' is not above 0 and at most 100 percent"),
        ("build a.obj -o b.lod --crease-angle 181", "--crease-angle", "'181' is not from 0 to 180 degrees"),
        ("export a.lod -o b.obj --level 11", "--level", "'11' is not a whole number from 0 to 10"),
        ("export a.lod -o b.obj --level 3", "--level 3", "finest level 2"),
        ("trace a.lod --pixel 9,0 --size 8x8 --text", "--pixel 9,0", "the last of which is 7,7"),
        ("trace a.lod --pixel -1,0 --text", "--pixel", "'-1,0' is not a pixel such as 320,200: two whole numbers from 0"),
        ("trace a.lod --pixel 1,1 --text --memory-latency 0", "--memory-latency", "'0' is not a whole number from 1 to 100000"),
        (
            "simulate a.lod --machine none",
            "--machine none",
            "there are: haydel2023, haydel2023-ddr3, haydel2023-mshr4, haydel2023-public, packet, turing2018",
        ),
    ] {
        let (code, text) = desk.hear(args);
        assert!(code != 0 && text.starts_with("error: ") && text.contains(option) && text.contains(limit), "{args}: {text}");
    }
    assert_eq!(desk.files(".").len(), 1, "a refusal has written something");
}

/// Names of all subcommands, as the help lists them.
fn commands(desk: &Desk) -> Vec<String> {
    let help = desk.run("--help");
    let listed = help.split("Commands:\n").nth(1).and_then(|text| text.split("\n\n").next()).unwrap();
    let names = listed.lines().filter(|line| line.starts_with("  ") && !line.starts_with("   "));
    let names: Vec<_> = names.map(|line| line.split_whitespace().next().unwrap().to_owned()).filter(|name| name != "help").collect();
    assert!(names.len() >= 20 && names.contains(&"stability".to_owned()), "{names:?}");
    names
}

/// What the program says in a terminal of 80 columns.
fn narrow(desk: &Desk, args: &str) -> String {
    let mut command = std::process::Command::new(assert_cmd::cargo::cargo_bin!("lodray"));
    command.current_dir(desk.folder()).env("COLUMNS", "80").env("LODRAY_CACHE", "none").args(args.split_whitespace());
    let output = command.output().unwrap();
    assert!(output.status.success(), "{args}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn tables_and_help_fit_a_terminal_of_80_columns() {
    let desk = empty();
    desk.run("generate sphere --levels 2 --base 32 -o a.lod");
    desk.run("simulate a.lod --size 16x16 -o sim");
    for args in [
        "render a.lod --size 16x16 --compare -o r",
        "lines a.lod --size 16x16",
        "simulate a.lod --size 16x16",
        "simulate a.lod --size 16x16 --compute units",
        "compare sim/result.json sim/result.json",
        "crack a.lod --rays 1000",
        "verify a.lod",
        "plan a.lod",
        "stability --case flat --rays 1000",
    ] {
        let (wide, narrow) = (desk.run(args), narrow(&desk, args));
        let longest = narrow.lines().max_by_key(|line| line.chars().count()).unwrap();
        assert!(longest.chars().count() <= 80, "{args}: {longest}");
        // Nothing is lost, but times differ.
        let figures = |text: &str| text.split_whitespace().collect::<std::collections::BTreeSet<_>>().len();
        assert!(args.starts_with("render") || figures(&narrow) == figures(&wide), "{args}: {narrow}");
    }
    for command in commands(&desk) {
        let help = narrow(&desk, &format!("{command} -h"));
        let longest = help.lines().max_by_key(|line| line.chars().count()).unwrap();
        assert!(longest.chars().count() <= 80, "{command}: {longest}");
    }
}

#[test]
fn colours_are_as_wanted() {
    let desk = empty();
    let has = |text: &str| text.contains('\u{1b}');
    assert!(has(&desk.run("--help --color always")) && has(&desk.run("--color=always info --help")));
    assert!(!has(&desk.run("--help --color never")) && !has(&desk.run("--help")));
    // Errors of the program, of its command line, and where the choice itself is wrong.
    for (args, code) in [("info none.lod", 1), ("info", 2)] {
        assert!(has(&desk.hear(&format!("{args} --color always")).1), "{args}");
        for never in ["", " --color never", " --color auto"] {
            let (got, said) = desk.hear(&format!("{args}{never}"));
            assert!(got == code && !has(&said) && said.starts_with("error: "), "{args}{never}: {said}");
        }
    }
    assert_eq!(desk.hear("info --color purple a.lod").0, 2);
}

#[test]
fn shells_and_man_know_every_command() {
    let desk = empty();
    let commands = commands(&desk);
    for shell in ["bash", "zsh", "fish"] {
        let script = desk.run(&format!("completions {shell}"));
        assert!(commands.iter().all(|name| script.contains(name)) && script.contains("memory-latency"), "{shell}");
    }
    desk.refused("completions csh", 2, &["'csh'", "bash"]);
    desk.run("man pages/man1");
    let pages = desk.files("pages/man1");
    for name in &commands {
        let page = &pages[&format!("lodray-{name}.1")];
        assert!(String::from_utf8_lossy(page).contains(".SH SYNOPSIS"), "{name}");
    }
    assert!(pages.contains_key("lodray.1"));
}

#[test]
fn one_knob_has_one_text_and_no_method_is_listed_that_is_refused() {
    let desk = empty();
    let text = |command: &str| {
        let help = desk.run(&format!("{command} --help"));
        let after = help.split("--delta <DELTA>").nth(1).unwrap_or_else(|| panic!("{command}: {help}"));
        after.split("[default").next().unwrap().split_whitespace().collect::<Vec<_>>().join(" ")
    };
    let words = text("render");
    assert!(words.starts_with("Quality"), "{words}");
    for command in ["trace", "lines", "cast", "plan", "simulate"] {
        assert_eq!(text(command), words, "{command}");
    }
    assert!(desk.run("render --help").contains("- original:") && !desk.run("cast --help").contains("- original:"));
    desk.refused("cast a.lod b.npy -o c.npy --method original", 2, &["'original'"]);
}

#[test]
fn the_plan_of_a_view_prunes() {
    let desk = empty();
    desk.run("generate terrain --levels 4 --base 32 -o a.lod");
    let said = desk.run("plan a.lod --distance 8,16 --size 64x64 -o plan.toml");
    assert!(said.starts_with("a unit for this has ") && said.lines().next().unwrap().contains(" GE (gate equivalents): "), "{said}");
    assert!(said.contains(" % less\nthan the unit of rtl/, with 4 contexts\n"), "{said}");
    assert!(desk.run("prune a.lod --plan plan.toml -o small.lod").starts_with("2 views; "));
    desk.refused("plan a.lod -o new --package ./new", 1, &["--package ./new: it is the file of the plan"]);
    desk.refused("plan a.lod --check plan.toml --json", 2, &["--json"]);
    assert!(fs::metadata(desk.path("small.lod")).unwrap().len() < fs::metadata(desk.path("a.lod")).unwrap().len());
    // The same as a list of jobs says.
    let list = "size = \"64x64\"\ndistances = [8, 16]\nmethods = [\"lod\"]\n[[scene]]\nfile = \"a.lod\"\n[[machine]]\nname = \"packet\"\n";
    desk.write("jobs.toml", list);
    let [of_options, of_list] = ["a.lod --distance 8,16 --size 64x64", "--job jobs.toml"].map(|args| desk.json(&format!("plan {args}")));
    assert_eq!((&of_options["unit"], &of_options["savings"]), (&of_list["unit"], &of_list["savings"]));
    assert!(of_options["unit"]["gates"].as_f64() < of_options["full_unit"]["gates"].as_f64());
    assert!(desk.run("plan a.lod --distance 8 --size 16x16 --speed").contains("speed: on "));
    desk.refused("plan a.lod --speed", 1, &["--speed", "--distance", "--job"]);
}

#[test]
fn what_a_base_loses_is_said_and_refused_if_strict() {
    let desk = empty();
    fs::write(desk.path("sheet.obj"), sheet(24)).unwrap();
    let (code, text) = desk.hear("build sheet.obj -o sheet.lod --levels 1 --base 20 --quiet");
    assert!(
        code == 0 && text.starts_with("warning: sheet.lod: it is up to ") && text.contains(" at (") && text.lines().count() == 1,
        "{text}"
    );
    let info = desk.run("info sheet.lod");
    assert!(info.contains("\nwarning     it is up to ") && !info.contains("\nnote "), "{info}");
    let (code, text) = desk.hear("build sheet.obj -o strict.lod --levels 1 --base 20 --strict");
    assert!(code == 1 && text.starts_with("error: sheet.obj: it is up to ") && !desk.path("strict.lod").exists(), "{text}");
    desk.run("build sheet.obj -o strict.lod --levels 3 --strict");
    assert!(!desk.run("info strict.lod").contains("warning"));
    // A triangle without area has a line, but is no loss; one that is there twice is.
    let sheet = desk.text("sheet.obj");
    let again = sheet.lines().find(|line| line.starts_with("f ")).unwrap();
    for (face, strict, said) in [("f 1 1 2", 0, "have no area"), (again, 1, "have the corners of another")] {
        desk.write("more.obj", &format!("{sheet}{face}\n"));
        let (code, text) = desk.hear("build more.obj -o more.lod --levels 3 --strict");
        assert!(code == strict && text.contains(said), "{text}");
    }
}

#[test]
fn a_base_that_cannot_be_met_and_an_error_that_cannot_be_met_are_said() {
    let desk = empty();
    // Two tetrahedra: no triangle of them can go.
    let corners = |x: u32| format!("v {x} 0 0\nv {} 0 0\nv {x} 1 0\nv {x} 0 1\n", x + 1);
    fs::write(
        desk.path("two.obj"),
        format!("{}{}f 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\nf 5 7 6\nf 5 6 8\nf 6 7 8\nf 7 5 8\n", corners(0), corners(5)),
    )
    .unwrap();
    let note = "\nnote        --base 3 was not met, the base has 8: how the mesh is connected, and its borders and creases, allow no fewer triangles\n";
    assert!(desk.run("build two.obj -o two.lod --levels 1 --base 3").contains(note));
    let info = desk.run("info two.lod") + "\n";
    assert!(info.contains(note) && !info.contains("\nwarning"), "{info}");
    let (code, text) = desk.hear("build two.obj -o two.lod --levels 1 --max-error 1e-9 --strict");
    let least = text.trim_end().strip_suffix(" or more").and_then(|text| text.rsplit_once(' ')).map_or("", |text| text.1);
    assert!(
        code == 1 && text.starts_with("error: two.obj: no result is sure to be within 0.000000001 % ") && text.lines().count() == 1,
        "{text}"
    );
    desk.run(&format!("build two.obj -o two.lod --levels 1 --max-error {least} --strict"));
    let (code, text) = desk.hear("build two.obj -o two.lod --levels 1 --base 8 --max-error 1e-9 --strict");
    assert!(code == 1 && text.contains(&format!("a --max-error of {least} or more")), "{text}");
}

#[test]
fn a_reader_that_leaves_early_is_no_error() {
    let desk = empty();
    desk.run("generate sphere --levels 1 --base 8 -o a.lod");
    for args in [&["info", "a.lod"][..], &["verify", "a.lod"], &["help"]] {
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let mut command = std::process::Command::new(assert_cmd::cargo::cargo_bin!("lodray"));
        let output = command.current_dir(desk.folder()).args(args).stdout(writer).output().unwrap();
        assert!(output.status.success() && output.stderr.is_empty(), "{args:?}: {output:?}");
    }
}
