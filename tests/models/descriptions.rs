//! Descriptions of several models as one scene, as a user types them: `simulate` and `render` give of them what they give of a model, and what they refuse is one line.

use image::RgbImage;
use lodray_test_support::program::{Desk, FAILS, USAGE, write_rays};
use serde_json::Value;
use xxhash_rust::xxh3::xxh3_64;

const LIGHT: &str = "[environment]\nzenith = [1, 1, 1]\nhorizon = [1, 1, 1]\nground = [1, 1, 1]\n";

/// A camera that looks at the origin.
fn camera(name: &str, eye: [f64; 3], size: [u32; 2]) -> String {
    let [width, height] = size;
    let picture = format!("[picture]\nwidth = {width}\nheight = {height}\nshadow_rays = false\n");
    format!("{picture}[[camera]]\nname = \"{name}\"\neye = {eye:?}\ntarget = [0.0, 0.0, 0.0]\nfov = 40.0\n")
}

/// One model of a file, placed by some keys.
fn model(file: &str, keys: &str) -> String {
    format!("[[model]]\nfile = \"{file}\"\n{keys}\n")
}

/// Ten models, of a scene and a generated one, beside and behind each other.
fn ten() -> String {
    let near = camera("near", [0.4, 1.5, 7.0], [48, 32]);
    let far = "[[camera]]\nname = \"far\"\neye = [0.0, 9.0, 30.0]\ntarget = [0.0, 0.0, 0.0]\n";
    let row = model("a.lod", "scale = 0.5\ntranslate = [-2.0, 0.0, -1.0]\ncopies = { count = [4, 1, 2], step = [1.3, 0.0, 2.0] }");
    let ball = "[[model]]\ngenerate = { scene = \"sphere\", levels = 3, base = 64 }\ntranslate = [0.0, 0.6, 0.5]\nscale = 0.4\n";
    let tall = "[[model]]\ngenerate = { scene = \"sphere\", levels = 3, base = 64 }\nmatrix = [[0.5, 0, 0, 1.8], [0, 1.2, 0, 0.2], [0, 0, 0.5, 0.4]]\n";
    [near, far.to_owned(), row, ball.to_owned(), tall.to_owned(), LIGHT.to_owned()].concat()
}

/// A folder with a scene of spikes, and descriptions of it.
fn desk() -> Desk {
    let desk = Desk::new(assert_cmd::cargo::cargo_bin!("lodray"));
    desk.run("generate spikes --levels 3 --base 64 -o a.lod");
    desk.write("ten.toml", &ten());
    desk.write("one.toml", &[camera("front", [0.3, 0.9, 3.1], [40, 36]), model("a.lod", ""), LIGHT.to_owned()].concat());
    desk
}

/// The same as one's options say them.
const OF_ONE: &str = "--eye 0.3,0.9,3.1 --target 0,0,0 --fov 40 --size 40x36";

fn picture(desk: &Desk, name: &str) -> RgbImage {
    image::open(desk.path(name)).unwrap().to_rgb8()
}

fn result(desk: &Desk, args: &str) -> Value {
    desk.json(&format!("simulate {args}"))
}

/// A result without what is said of the scene.
fn figures(mut result: Value) -> Value {
    result["setup"]["scene"].take();
    result
}

#[test]
fn a_model_at_rest_is_its_scene() {
    let desk = desk();
    for options in ["", "--method bvh", "--method discrete", "--delta 0.5 --frames 3 --turn 20", "--compute units"] {
        let [own, described] = [format!("a.lod {OF_ONE} {options}"), format!("one.toml {options}")].map(|args| result(&desk, &args));
        assert_eq!(described["setup"]["scene"]["name"], own["setup"]["scene"]["name"]);
        assert!(own["hits"].as_u64() > Some(200));
        assert_eq!(figures(own), figures(described), "{options}");
    }
    for options in ["", "--shading full", "--shading weighted --samples 4"] {
        let [own, described] =
            [format!("render a.lod {OF_ONE} {options} -o own"), format!("render one.toml {options} -o other")].map(|args| desk.json(&args));
        for key in ["stats", "per_ray", "size", "eye", "distance"] {
            assert_eq!(own[key], described[key], "{options}: {key}");
        }
        for name in ["image", "levels", "normals", "sheet"].map(|name| format!("{name}.png")) {
            assert!(picture(&desk, &format!("own/{name}")) == picture(&desk, &format!("other/{name}")), "{options}: {name}");
        }
    }
}

#[test]
fn frames_are_those_of_paths_without_bounces() {
    let desk = desk();
    for method in ["lod", "bvh", "discrete"] {
        desk.run(&format!("paths ten.toml --machine haydel2023 --depth 0 --samples 1 --method {method} -o paths --force"));
        let paths: Value = serde_json::from_str(&desk.text("paths/result.json")).unwrap();
        let simulated = result(&desk, &format!("ten.toml --method {method}"));
        assert_eq!(simulated["rays"], 48 * 32);
        assert!(simulated["hits"].as_u64() > Some(300));
        for key in ["cycles", "rays", "hits", "accesses_per_ray", "l2", "dram", "traffic"] {
            assert_eq!(paths[0][key], simulated[key], "{method}: {key}");
        }
        // Rays of paths may wait for others, so they are handed out a little differently: queues are not the same.
        for key in ["requests", "hits", "misses", "merges"] {
            assert_eq!(paths[0]["l1"][key], simulated["l1"][key], "{method}: {key}");
        }
        for name in ["instance_transform", "ray_setup", "child_test", "lod_test"] {
            assert!(simulated["operations"][name].as_u64() > Some(0) || method != "lod", "{name}: {}", simulated["operations"]);
        }
        assert_eq!(paths[0]["operations"]["instance_transform"], simulated["operations"]["instance_transform"]);
        assert_eq!(paths[0]["setup"]["scene"], simulated["setup"]["scene"]);
        // A picture counts what a machine does.
        let drawn = desk.json(&format!("render ten.toml --method {method} -o drawn"));
        assert_eq!((&drawn["stats"]["rays"], &drawn["stats"]["hits"]), (&simulated["rays"], &simulated["hits"]), "{method}");
        let lines = drawn["stats"]["lines"].as_array().unwrap().iter().map(|kind| kind["read"].as_u64().unwrap()).sum::<u64>();
        assert_eq!(lines as f64 / (48.0 * 32.0), simulated["accesses_per_ray"].as_f64().unwrap(), "{method}");
    }
}

#[test]
fn results_say_what_models_there_were() {
    let desk = desk();
    let all = result(&desk, "ten.toml")["setup"]["scene"].take();
    let [row, ball, tall] = [0usize, 1, 2].map(|k| &all["models"]["models"][k]);
    assert_eq!([row, ball, tall].map(|own| own["places"].as_u64()), [Some(8), Some(1), Some(1)]);
    assert_eq!((all["name"].as_str(), all["models"]["description"].as_str()), (Some("ten.toml, 10 models"), Some("ten.toml")));
    for key in ["base_triangles", "finest_triangles"] {
        let [row, ball, tall] = [row, ball, tall].map(|own| own[key].as_u64().unwrap());
        assert_eq!(all[key].as_u64(), Some(8 * row + ball + tall), "{key}");
    }
    let bytes = [desk.bytes("ten.toml"), desk.bytes("a.lod")].concat();
    assert_eq!(all["models"]["xxh3"], format!("{:016x}", xxh3_64(&bytes)));
    let one = result(&desk, "one.toml")["setup"]["scene"].take();
    assert_eq!(one["finest_triangles"], row["finest_triangles"]);
    assert_eq!(one["models"]["models"][0]["places"], 1);
    // Files, a page, and a waveform as of one model.
    desk.run("simulate ten.toml --machine haydel2023,packet -o several --report page.html --quiet");
    desk.run("simulate ten.toml --frames 2 --turn 10 -o moving --quiet");
    desk.run("simulate ten.toml --vcd wave.vcd --window 0:500 --quiet");
    assert!(desk.text("page.html").contains("ten.toml, 10 models") && desk.text("wave.vcd").contains("$enddefinitions"));
    let inputs: Value = serde_json::from_str(&desk.text("moving/run.json")).unwrap();
    let names: Vec<_> = inputs["inputs"].as_array().unwrap().iter().filter_map(|input| input["name"].as_str()).collect();
    assert_eq!(names[..2], ["ten.toml", "a.lod"]);
    assert_eq!(serde_json::from_str::<Value>(&desk.text("moving/result.json")).unwrap()["setup"]["frames"], 2);
    // Rays of a file meet what `cast` says.
    let rows: Vec<f64> =
        (0..100).flat_map(|k| [f64::from(k % 10) * 0.4 - 2.0, f64::from(k / 10) * 0.2 - 0.8, 5.0, 0.0, 0.0, -1.0]).collect();
    write_rays(&desk.path("rays.npy"), 6, &rows);
    let cast = desk.json("cast ten.toml rays.npy -o hits.npy");
    let simulated = result(&desk, "ten.toml --rays rays.npy");
    assert!(cast["hits"].as_u64() > Some(20) && (&cast["rays"], &cast["hits"]) == (&simulated["rays"], &simulated["hits"]), "{cast}");
}

#[test]
fn the_cameras_of_a_description_are_overruled_by_options() {
    let desk = desk();
    let view = |options: &str| result(&desk, &format!("ten.toml {options}"))["setup"]["view"].take();
    let of = |view: &Value| (view["size"].to_string(), view["eye"].to_string());
    assert_eq!(of(&view("")), ("[48,32]".to_owned(), "[0.4,1.5,7.0]".to_owned()));
    assert_eq!(of(&view("--camera far --size 16x8")), ("[16,8]".to_owned(), "[0.0,9.0,30.0]".to_owned()));
    assert_eq!(of(&view("--camera far --eye 0,0,20 --size 16x8")).1, "[0.0,0.0,20.0]");
    // Angles turn the camera about its target, as far from it as it was.
    let front = view("--view front --size 16x8");
    let eye: [f64; 3] = serde_json::from_value(front["eye"].clone()).unwrap();
    let away = (0.4f64 * 0.4 + 1.5 * 1.5 + 49.0).sqrt();
    assert!(eye[0].abs() < 1e-9 && eye[1].abs() < 1e-9 && (eye[2] - away).abs() < 1e-9, "{eye:?}");
    // A distance is in radii of all models.
    let [near, far] = [2.0, 4.0].map(|radii| {
        let eye: [f64; 3] = serde_json::from_value(view(&format!("--distance {radii} --size 16x8"))["eye"].clone()).unwrap();
        eye.iter().map(|v| v * v).sum::<f64>().sqrt()
    });
    assert!((far - 2.0 * near).abs() < 1e-9 && (2.0..12.0).contains(&near), "{near} {far}");
}

/// How many pixels differ by more than rounding, and how many there are.
fn differing(a: &RgbImage, b: &RgbImage) -> (usize, usize) {
    let off = a.pixels().zip(b.pixels()).filter(|(a, b)| (0..3).any(|k| a.0[k].abs_diff(b.0[k]) > 2));
    (off.count(), a.pixels().count())
}

/// Surfaces are shaded through their poses: what is turned, scaled, moved or mirrored together with its camera looks the same.
#[test]
fn poses_keep_pictures() {
    let desk = desk();
    let with = |name: &str, eye: [f64; 3], target: [f64; 3], keys: &str| {
        let text =
            [camera("front", eye, [64, 64]).replace("target = [0.0, 0.0, 0.0]", &format!("target = {target:?}")), model("a.lod", keys)];
        desk.write(name, &(text.concat() + LIGHT));
    };
    with("plain.toml", [1.0, 0.5, 3.0], [0.0; 3], "");
    // By 90 degrees about y +z becomes +x, and +x becomes -z.
    with("turned.toml", [3.0 + 6.0, 5.0 + 1.0, -1.0 - 2.0], [3.0, 5.0, -1.0], "rotate = [0, 90, 0]\nscale = 2.0\ntranslate = [3, 5, -1]");
    with("mirrored.toml", [-1.0, 0.5, 3.0], [0.0; 3], "matrix = [[-1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]]");
    for shading in ["full", "level", "weighted", "facets"] {
        let [plain, turned, mirrored] = ["plain", "turned", "mirrored"].map(|name| {
            desk.run(&format!("render {name}.toml --shading {shading} -o {name} --force --quiet"));
            picture(&desk, &format!("{name}/image.png"))
        });
        let mirrored = image::imageops::flip_horizontal(&mirrored);
        for (name, other) in [("turned", turned), ("mirrored", mirrored)] {
            let (off, all) = differing(&plain, &other);
            assert!(100 * off < 3 * all, "{shading}, {name}: {off} of {all}");
        }
    }
    // A normal is turned with its model.
    let [plain, turned] = ["plain", "turned"].map(|name| picture(&desk, &format!("{name}/normals.png")));
    let pixel = |picture: &RgbImage| picture.get_pixel(32, 32).0;
    let ([x, y, z], [tx, ty, tz]) = (pixel(&plain), pixel(&turned));
    assert!(tx.abs_diff(z) <= 3 && ty.abs_diff(y) <= 3 && tz.abs_diff(255 - x) <= 3, "{x} {y} {z}: {tx} {ty} {tz}");
}

#[test]
fn pictures_are_compared_with_full_resolution() {
    let desk = desk();
    let full = desk.json("render ten.toml --delta inf --compare -o full");
    assert_eq!((full["error"]["coverage_differs"].as_u64(), full["error"]["psnr_db"].is_null()), (Some(0), true));
    assert_eq!(full["error"]["geometry_pixels"]["maximum"], 0.0);
    let coarse = desk.json("render ten.toml --delta 0.3 --compare -o coarse");
    let of = |made: &Value, key: &str| made["stats"][key].as_f64().unwrap();
    assert!(of(&coarse, "mean_level") < of(&full, "mean_level") - 0.5);
    assert!(coarse["error"]["psnr_db"].as_f64() > Some(10.0) && coarse["against"] == "full_resolution");
    for name in ["image.png", "levels.png", "normals.png", "error.png", "sheet.png", "run.json"] {
        assert!(desk.path(&format!("coarse/{name}")).is_file(), "{name}");
    }
    assert_eq!(picture(&desk, "coarse/image.png").dimensions(), (48, 32));
    // The same at any number of threads.
    desk.run_on(1, "render ten.toml --delta 0.3 --samples 4 -o alone");
    desk.run_on(3, "render ten.toml --delta 0.3 --samples 4 -o three");
    assert!(picture(&desk, "alone/image.png") == picture(&desk, "three/image.png"));
}

/// The ten, of which the row of eight goes forwards.
fn moving() -> String {
    ten().replacen("step = [1.3, 0.0, 2.0] }", "step = [1.3, 0.0, 2.0] }\nmoves = { by = [0.0, 0.0, 2.0] }", 1)
}

#[test]
fn models_move_from_frame_to_frame() {
    let desk = desk();
    desk.write("moving.toml", &moving());
    // Half of the way written out.
    desk.write("half.toml", &ten().replacen("translate = [-2.0, 0.0, -1.0]", "translate = [-2.0, 0.0, 0.0]", 1));
    assert_eq!(result(&desk, "moving.toml")["hits"], result(&desk, "ten.toml")["hits"]);
    for method in ["lod", "bvh", "discrete", "cluster"] {
        let all = result(&desk, &format!("moving.toml --frames 3 --turn 0 --method {method}"));
        let hits =
            [0.0, 0.5, 1.0].map(|time| result(&desk, &format!("moving.toml --time {time} --method {method}"))["hits"].as_u64().unwrap());
        // What is chosen for the whole sequence may be a little finer than for a frame alone.
        let (sum, alone) = (all["hits"].as_u64().unwrap(), hits.iter().sum::<u64>());
        assert!(sum.abs_diff(alone) < 10 && hits[0] != hits[1] && hits[1] != hits[2], "{method}: {sum} {hits:?}");
        assert_eq!(hits[1], result(&desk, &format!("half.toml --method {method}"))["hits"], "{method}");
        // The tree over ten places, of five nodes, is built anew before all frames but the first, and eight places are written.
        let frames = all["frames"].as_array().unwrap();
        let stores = |frame: &Value| frame["before"]["stores"].as_u64();
        let own = stores(&frames[0]);
        assert!(
            (own.is_none() || method == "cluster") && frames[1..].iter().all(|frame| stores(frame) >= Some(8 * 2 + 5 * 4)),
            "{frames:?}"
        );
        assert!(method == "cluster" || frames[1..].iter().all(|frame| stores(frame) == Some(8 * 2 + 5 * 4)), "{frames:?}");
        assert!(frames[1]["before"]["energy"].as_f64() > Some(0.0) && all["operations"]["instance_box"] == 2 * 10);
        let still = result(&desk, &format!("ten.toml --frames 3 --turn 0 --method {method}"));
        assert!(still["operations"].get("instance_box").is_none() && (method == "cluster" || still["frames"][1].get("before").is_none()));
    }
    // Pictures are those of their time; a flight has one for each frame.
    for (name, args) in [("time", "moving.toml --time 0.5"), ("half", "half.toml")] {
        desk.run(&format!("render {args} --shading full -o {name} --quiet"));
    }
    let flight = desk.json("fly moving.toml --frames 3 --size 48x32 -o flight");
    assert_eq!((flight["frames"].as_array().map(Vec::len), flight.get("worst")), (Some(3), None));
    let [time, half, flown] = ["time/image.png", "half/image.png", "flight/frame-00001.png"].map(|name| picture(&desk, name));
    assert!(time == half && time == flown && flown != picture(&desk, "flight/frame-00000.png"));
    // Paths see the same time, and pages and waveforms are made of what moves.
    for (name, args) in [("now", "moving.toml --time 0.5"), ("written", "half.toml")] {
        desk.run(&format!("paths {args} --samples 1 -o {name} --quiet"));
    }
    assert!(picture(&desk, "now/paths.png") == picture(&desk, "written/paths.png"));
    desk.run("simulate moving.toml --frames 2 --turn 5 --report moving.html -o run --quiet");
    assert!(desk.text("moving.html").contains("moving.toml, 10 models"));
    for (args, words) in [
        ("simulate moving.toml --frames 2 --time 0.5", "--time: is of one frame; several lie evenly from time 0 to time 1"),
        ("fly moving.toml --time 0.5", "--time: is of one frame"),
        ("render a.lod --time 0.5", "--time: goes with the description of several models"),
    ] {
        desk.refused(&format!("{args} -o new"), FAILS, &[words]);
    }
    desk.refused("render moving.toml --time 1.5 -o new", USAGE, &["'1.5' is not a time from 0 to 1"]);
}

#[test]
fn what_goes_with_one_scene_alone_is_refused() {
    let desk = desk();
    let said = [
        ("simulate ten.toml --compute units", "the scene has 10 models, and rays of traversal units go through one"),
        ("simulate ten.toml --mesh a.obj", "--mesh: goes with one scene, and not with several models"),
        ("simulate ten.toml --method input-bvh", "--method input-bvh: meshes that scenes were built from are not looked for among several"),
        ("simulate ten.toml --packet 32", "--packet: rays through several models are traced one by one"),
        ("simulate ten.toml --method stochastic", "--method stochastic: rays cannot leave its surface, or go from one model to the next"),
        ("simulate ten.toml --camera side", "ten.toml: there is no camera 'side'; there are: near, far"),
        ("simulate a.lod --camera near", "--camera: goes with the description of several models"),
        ("render ten.toml --method original", "--method original: is of one scene, and not of several models"),
        ("render ten.toml --mesh a.obj --compare", "--mesh: goes with one scene, and not with several models"),
        ("render a.lod --camera near", "--camera: goes with the description of several models"),
        ("render none.toml", "none.toml"),
    ];
    for (args, words) in said {
        desk.refused(&format!("{args} -o new"), FAILS, &[words]);
        assert!(!desk.path("new").exists() || args.contains("units") || args.contains("stochastic"), "{args}: made its folder");
    }
    desk.run("plan a.lod --distance 8 --size 16x16 -o plan.toml --quiet");
    desk.refused("simulate ten.toml --plan plan.toml", FAILS, &["--plan: is of one scene, and not of several models"]);
    desk.run("prune a.lod --plan plan.toml -o small.lod --quiet");
    desk.write("small.toml", &ten().replace("a.lod", "small.lod"));
    desk.refused("simulate small.toml", FAILS, &["small.toml: model[0]: small.lod: job: the scene was pruned for the rays of a job"]);
}
