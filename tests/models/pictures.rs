//! `render`'s cameras, legends, texts, contact sheet, and the original beside the result, as a user types them.

use image::RgbImage;
use lodray::format::Scene;
use lodray::method::bvh::NoStore;
use lodray::method::{Knobs, lod};
use lodray::picture::{level_map, normal_map, render};
use lodray::rays::{Camera, ModelSpace, View};
use lodray_test_support::program::{Desk, FAILS, USAGE};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;

/// A folder with a scene, to run the program in.
fn with(scene: &str) -> Desk {
    let desk = Desk::new(assert_cmd::cargo::cargo_bin!("lodray"));
    desk.run(&format!("generate {scene} -o a.lod"));
    desk
}

/// Expects an error, and no folder.
fn refused(desk: &Desk, args: &str, code: i32, words: &[&str]) {
    desk.refused(args, code, words);
    assert!(!desk.path("new").exists(), "{args}: made its folder");
}

fn picture(desk: &Desk, name: &str) -> RgbImage {
    image::open(desk.path(name)).unwrap().to_rgb8()
}

/// What a picture says of itself.
fn notes_of(desk: &Desk, name: &str) -> BTreeMap<String, String> {
    let file = std::io::BufReader::new(fs::File::open(desk.path(name)).unwrap());
    let reader = png::Decoder::new(file).read_info().unwrap();
    reader.info().uncompressed_latin1_text.iter().map(|t| (t.keyword.clone(), t.text.clone())).collect()
}

fn vector(value: &Value) -> [f64; 3] {
    serde_json::from_value(value.clone()).unwrap()
}

#[test]
fn the_default_view_holds_the_whole_model() {
    let desk = with("spikes --levels 2 --base 32");
    for size in ["64x64", "90x40", "24x80"] {
        let made = desk.json(&format!("render a.lod --size {size} -o out"));
        let image = picture(&desk, "out/image.png");
        let (width, height) = image.dimensions();
        let background = *image.get_pixel(0, 0);
        let border = |x, y| x == 0 || y == 0 || x + 1 == width || y + 1 == height;
        assert!(image.enumerate_pixels().all(|(x, y, p)| !border(x, y) || *p == background), "{size}: cut off");
        assert!(made["stats"]["hits"].as_u64().unwrap() > 100, "{size}");

        // As a number it is the same view.
        let placed = made["distance"].as_f64().unwrap();
        desk.run(&format!("render a.lod --size {size} --distance {placed} -o same"));
        assert_eq!(desk.bytes("same/image.png"), desk.bytes("out/image.png"));
        let simulated = desk.json(&format!("simulate a.lod --size {size}"));
        assert_eq!(simulated["setup"]["view"]["distance"].as_f64().unwrap(), placed);
        assert_eq!(simulated["setup"]["view"]["eye"], made["eye"]);
    }
    let near = desk.json("render a.lod --size 64x64 --distance 2 -o near");
    assert_eq!(near["distance"], 2.0);
    assert!(desk.json("simulate a.lod --size 8x8 --eye 0,0,9")["setup"]["view"]["distance"].is_null());
}

#[test]
fn views_go_around_the_model() {
    let desk = with("terrain --levels 2 --base 32");
    let space = ModelSpace::of(&Scene::open(&desk.path("a.lod")).unwrap());
    // From the target to the eye, in radii.
    let seen_from = |options: &str| {
        let made = desk.json(&format!("render a.lod --size 16x12 --distance 2 {options} -o out"));
        let (eye, centre) = (vector(&made["eye"]), space.centre());
        let v: [f64; 3] = std::array::from_fn(|k| (eye[k] - centre[k]) / space.radius() / 2.0);
        (v, desk.bytes("out/image.png"))
    };
    let close = |a: [f64; 3], b: [f64; 3]| (0..3).all(|k| (a[k] - b[k]).abs() < 1e-9);
    for (options, direction) in [
        ("--view front", [0.0, 0.0, 1.0]),
        ("--view back", [0.0, 0.0, -1.0]),
        ("--view side", [1.0, 0.0, 0.0]),
        ("--view left", [-1.0, 0.0, 0.0]),
        ("--view top", [0.0, 1.0, 0.0]),
        ("--view bottom", [0.0, -1.0, 0.0]),
        ("--view front --up z", [0.0, -1.0, 0.0]),
        ("--view side --up z", [1.0, 0.0, 0.0]),
        ("--view top --up -x", [-1.0, 0.0, 0.0]),
        ("--pitch 30", [0.0, 0.5, 0.75f64.sqrt()]),
        ("--yaw -30", [-0.5, 0.0, 0.75f64.sqrt()]),
        ("--yaw 180 --pitch -30 --up z", [0.0, 0.75f64.sqrt(), -0.5]),
    ] {
        let (v, _) = seen_from(options);
        assert!(close(v, direction), "{options}: {v:?}");
    }
    let length = (0.35f64 * 0.35 + 0.25 + 1.0).sqrt();
    assert!(close(seen_from("").0, [0.35, 0.5, 1.0].map(|c| c / length)));
    assert!(close(seen_from("--up z").0, [0.35, -1.0, 0.5].map(|c| c / length)));
    for (a, b) in [
        ("--up y", ""),
        ("--up z", "--up 0,0,1"),
        ("--up -x --pitch 3", "--up -1,0,0 --yaw 0 --pitch 3"),
        ("--view side", "--yaw 90"),
        ("--view side", "--view right"),
        ("--view three-quarter", "--yaw 35 --pitch 25"),
    ] {
        assert!(seen_from(a).1 == seen_from(b).1, "{a} and {b} differ");
    }
    assert!(seen_from("--view top").1 != seen_from("--view bottom").1);
}

#[test]
fn limits_are_named() {
    let desk = with("sphere --levels 1 --base 8");
    for (options, code, words) in [
        ("--size 100000x100000", USAGE, &["--size", "'100000x100000'", "1 to 65536", "67108864"][..]),
        ("--size 65536x65536", USAGE, &["--size", "'65536x65536'", "67108864"]),
        ("--eye 1e300,0,0", USAGE, &["--eye", "'1e300,0,0'", "from -1e100 to 1e100"]),
        ("--target 0,-inf,0", USAGE, &["--target", "'0,-inf,0'", "1e100"]),
        ("--up 0,0,0", USAGE, &["--up", "'0,0,0'", "1e-100"]),
        ("--up w", USAGE, &["--up", "'w'", "x, y, z"]),
        ("--up 0,0,1 --eye 0,0,5 --target 0,0,0", FAILS, &["--up", "nor along the view direction"]),
        ("--fov 180", USAGE, &["--fov", "'180'", "between 0 and 180"]),
        ("--fov 1e-9", FAILS, &["--distance must be given", "1000000 bounding radii"]),
        ("--distance 1e9", USAGE, &["--distance", "'1e9'", "1e-6 to 1e6"]),
        ("--yaw 361", USAGE, &["--yaw", "'361'", "-360 to 360"]),
        ("--pitch -91", USAGE, &["--pitch", "'-91'", "-90 to 90"]),
        ("--yaw nan", USAGE, &["--yaw", "'nan'"]),
        ("--yaw 3 --eye 1,2,3", USAGE, &["--yaw", "--eye"]),
        ("--pitch 3 --view top", USAGE, &["--pitch", "--view"]),
        ("--eye 1,2,3 --view top", USAGE, &["--eye", "--view"]),
        ("--view above", USAGE, &["'above'", "three-quarter"]),
    ] {
        refused(&desk, &format!("render a.lod -o new {options}"), code, words);
    }
}

#[test]
fn legends_stand_below_and_leave_the_picture_alone() {
    let desk = with("terrain --levels 3 --base 32");
    let scene = Scene::open(&desk.path("a.lod")).unwrap();
    let space = ModelSpace::of(&scene);
    for (width, height) in [(1, 1), (70, 41), (640, 20)] {
        desk.run(&format!("render a.lod --size {width}x{height} --compare -o out"));
        let camera = Camera::new(&View::default(), &space, width, height).unwrap();
        let method = (lod::METHOD.make)(&scene, &Knobs::default(), &NoStore).unwrap();
        let (frame, _) = render(&*method, &space, &camera, 1.0, &|| ());
        let crop = |name: &str| {
            let picture = picture(&desk, name);
            assert!(picture.height() > height, "{name}: no legend");
            image::imageops::crop_imm(&picture, 0, 0, width, height).to_image()
        };
        assert!(crop("out/levels.png") == level_map(&frame), "{width}x{height}");
        assert!(crop("out/normals.png") == normal_map(&frame, &scene), "{width}x{height}");
        crop("out/error.png");
        assert_eq!(picture(&desk, "out/image.png").dimensions(), (width, height));
    }
}

#[test]
fn pictures_say_what_they_are() {
    let desk = with("sphere --levels 2 --base 32");
    let made = desk.json("render a.lod --size 30x20 --view three-quarter --delta 2 --compare -o out");
    for name in ["image", "levels", "normals", "error", "sheet"] {
        let notes = notes_of(&desk, &format!("out/{name}.png"));
        let title = notes["Title"].replace("contact ", "");
        assert!(title.starts_with("sphere: lod at delta 2, 30x20 from ") && title.ends_with(name), "{title}");
        assert_eq!([&notes["Scene"], &notes["Method"], &notes["Delta"], &notes["Size"]], ["sphere", "lod", "2", "30x20"]);
        assert_eq!(notes["Software"], format!("lodray {}", env!("CARGO_PKG_VERSION")));
        assert_eq!(notes["Hits"], made["stats"]["hits"].to_string());
        assert_eq!(notes["RMSE"], format!("{:.3} of 255", made["error"]["rmse"].as_f64().unwrap()));
        assert_eq!(notes["Compared with"], "full resolution");
        assert!(notes["Distance"].starts_with(&made["distance"].to_string()) && notes.contains_key("Lines per ray"), "{notes:?}");
        // No paths.
        assert!(!notes.values().any(|text| text.contains("a.lod") || text.contains("out")), "{notes:?}");
    }
    // The options that it names give the same picture.
    let notes = notes_of(&desk, "out/image.png");
    let [eye, target, up] = ["Eye", "Target", "Up"].map(|key| &notes[key]);
    desk.run(&format!("render a.lod --size 30x20 --delta 2 --eye {eye} --target {target} --up {up} -o again"));
    assert!(picture(&desk, "again/image.png") == picture(&desk, "out/image.png"));
    assert!(!notes_of(&desk, "again/image.png").contains_key("RMSE"));
}

#[test]
fn the_contact_sheet_is_the_same_at_any_number_of_threads() {
    let sheets = [1, 2].map(|threads| {
        let desk = with("spikes --levels 2 --base 32");
        let (code, said, err) = desk.run_on(threads, "render a.lod --size 60x40 --compare -o out");
        assert_eq!((code, err.as_str()), (0, ""), "{said}");
        assert!(said.contains("building ") && said.contains("tracing "), "{said}");
        desk.bytes("out/sheet.png")
    });
    assert!(sheets[0] == sheets[1]);
    let sheet = image::load_from_memory(&sheets[0]).unwrap().to_rgb8();
    // Six places, three or two across, each with a picture enlarged four times.
    assert!(sheet.width() > 2 * 240 && sheet.height() > 2 * 160, "{:?}", sheet.dimensions());
}

#[test]
fn shadings_and_samples() {
    let desk = with("terrain --levels 3 --base 32");
    let image = |options: &str| {
        let made = desk.json(&format!("render a.lod --size 40x30 {options} -o out"));
        (picture(&desk, "out/image.png"), made)
    };
    let (default, made) = image("");
    assert_eq!((&made["shading"], &made["samples"]), (&"facets".into(), &1.into()));
    assert!(default == image("--shading facets --samples 1").0);
    let pictures = ["full", "level", "weighted", "facets"].map(|shading| image(&format!("--shading {shading} --delta 0.25 --samples 4")));
    for (at, (picture, made)) in pictures.iter().enumerate() {
        assert_eq!((&made["samples"], &made["stats"]["rays"]), (&4.into(), &1200.into()));
        assert!(pictures[..at].iter().all(|(other, _)| other != picture), "{}", made["shading"]);
    }
    let notes = notes_of(&desk, "out/image.png");
    assert_eq!([&notes["Shading"], &notes["Samples"]], ["facets", "4"]);
    // A difference to itself: full resolution has the same samples.
    assert_eq!(image("--method reference --samples 16 --compare").1["error"]["rmse"], 0.0);
    refused(&desk, "render a.lod -o new --samples 3", USAGE, &["--samples", "'3'", "16"]);
    refused(&desk, "render a.lod -o new --shading none", USAGE, &["--shading", "'none'", "weighted"]);
    refused(&desk, "render a.lod -o new --samples 64 --size 8192x8192", FAILS, &["--samples", "65536"]);
}

#[test]
fn the_original_beside_the_scene_of_it() {
    let desk = with("sphere --levels 0 --base 512");
    desk.run("export a.lod -o a.obj");
    let full = desk.json("render a.lod --method reference --size 80x60 -o full");
    let original = desk.json("render a.lod --method original --mesh a.obj --size 80x60 -o over");
    assert_eq!((&original["method"], &original["eye"]), (&"original".into(), &full["eye"]));
    assert!(original["stats"]["hits"].as_u64().unwrap().abs_diff(full["stats"]["hits"].as_u64().unwrap()) <= 4);

    // The scene of the mesh without splits: the same triangles.
    desk.run("build a.obj --levels 0 --base 512 -o b.lod");
    let error = desk.json("render b.lod --delta inf --compare --mesh a.obj --size 80x60 -o both");
    assert_eq!(error["against"], "original");
    assert!(error["error"]["coverage_differs"].as_u64().unwrap() <= 4, "{error}");
    assert!(error["error"]["geometry_pixels"]["maximum"].as_f64().unwrap() < 0.01, "{error}");
    assert!(error["error"]["rmse"].as_f64().unwrap() < 5.0, "{error}");
    assert_eq!(notes_of(&desk, "both/sheet.png")["Compared with"], "the original");
    assert_eq!(desk.json("render a.lod --compare --size 8x8 -o both")["against"], "full_resolution");

    // A mesh that is elsewhere is off by no number of pixels.
    desk.write("far.obj", "v 90 90 90\nv 91 90 90\nv 90 91 90\nf 1 2 3\n");
    let apart = "render a.lod --compare --mesh far.obj --size 80x60 -o apart";
    let error = desk.json(apart);
    assert!(error["error"]["geometry_pixels"].is_null() && error["error"]["coverage_differs"].as_u64().unwrap() > 100, "{error}");
    let said = desk.run(apart);
    assert!(said.contains("\nno pixel sees the surface in both: nothing overlaps\n") && !said.contains("surface off by"), "{said}");
    assert_eq!(notes_of(&desk, "apart/sheet.png")["Surfaces"], "do not overlap");

    // Alone, it is its own model.
    let alone = desk.json("render a.obj --method original --size 80x60 -o alone");
    assert_eq!(notes_of(&desk, "alone/image.png")["Scene"], "a");
    assert!(alone["stats"]["lines"].as_array().unwrap().is_empty() && alone["stats"]["mean_level"] == 0.0);
    let differing =
        picture(&desk, "alone/image.png").pixels().zip(picture(&desk, "over/image.png").pixels()).filter(|(a, b)| a != b).count();
    assert!(differing < 80, "{differing}");
}

#[test]
fn the_original_keeps_its_colours() {
    let desk = with("sphere --levels 0 --base 8");
    fs::write(desk.path("c.mtl"), "newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\n").unwrap();
    let mesh = "mtllib c.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nusemtl red\nf 1 2 3\nusemtl blue\nf 2 4 3\n";
    fs::write(desk.path("c.obj"), mesh).unwrap();
    desk.run("render c.obj --method original --view front --size 40x40 -o out");
    let image = picture(&desk, "out/image.png");
    for bright in [0, 2] {
        let pure = image.pixels().filter(|p| (0..3).all(|k| (p.0[k] > 200) == (k == bright))).count();
        assert!(pure > 50, "channel {bright}: {pure}");
    }
}

#[test]
fn what_the_original_does_not_go_with() {
    let desk = with("sphere --levels 1 --base 8");
    fs::write(desk.path("bad.obj"), "v 0 0 0\nf 1 2 3\n").unwrap();
    fs::write(desk.path("empty.obj"), "").unwrap();
    fs::write(desk.path("notes.txt"), "hello").unwrap();
    for (args, words) in [
        ("render a.lod -o new --mesh a.obj", "--mesh: goes with --compare or with --method original"),
        ("render a.lod -o new --method original", "a.lod: is a scene"),
        ("render a.lod -o new --method original --mesh a.lod", "a.lod: is a scene"),
        ("render a.lod -o new --method original --compare", "--compare: "),
        ("render none.obj -o new --method original", "none.obj: "),
        ("render bad.obj -o new --method original", "bad.obj: "),
        ("render empty.obj -o new --method original", "empty.obj: "),
        ("render notes.txt -o new --method original", "notes.txt: "),
        ("render a.lod -o new --compare --mesh bad.obj", "bad.obj: "),
    ] {
        refused(&desk, args, FAILS, &[words]);
    }
}
