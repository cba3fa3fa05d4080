//! Methods over the mesh that a scene was built from.

use lodray_test_support::program::{Desk, FAILS, USAGE};
use serde_json::Value;

/// A bumpy sphere of 2,016 triangles.
fn mesh(bump: f64) -> String {
    let (columns, rows) = (32, 32);
    let mut text = String::new();
    for row in 0..=rows {
        for column in 0..columns {
            let (a, b) =
                (f64::from(row) * std::f64::consts::PI / f64::from(rows), f64::from(column) * std::f64::consts::TAU / f64::from(columns));
            let r = 1.0 + bump * (7.0 * a).sin() * (5.0 * b).cos();
            text += &format!("v {} {} {}\n", r * a.sin() * b.cos(), r * a.cos(), r * a.sin() * b.sin());
        }
    }
    let at = |row: i32, column: i32| row * columns + column % columns + 1;
    for row in 0..rows {
        for column in 0..columns {
            // At the first pole it has no area; the sine at the other is not 0.
            if row > 0 {
                text += &format!("f {} {} {}\n", at(row, column), at(row, column + 1), at(row + 1, column));
            }
            text += &format!("f {} {} {}\n", at(row, column + 1), at(row + 1, column + 1), at(row + 1, column));
        }
    }
    text
}

fn desk() -> Desk {
    let desk = Desk::new(assert_cmd::cargo::cargo_bin!("lodray"));
    desk.write("ball.obj", &mesh(0.05));
    desk.run("build ball.obj --levels 3 -o ball.lod");
    desk
}

fn figures(result: &Value) -> Vec<&Value> {
    ["cycles", "rays", "hits", "l1", "l2", "dram", "energy"].map(|key| &result[key]).to_vec()
}

#[test]
fn a_bvh_over_the_input_is_that_of_a_scene_which_is_the_mesh() {
    let desk = desk();
    desk.run("build ball.obj --levels 0 --base 100000 --vertices exact -o whole.lod");
    for (of_input, of_finest) in [("input-bvh", "bvh"), ("input-bvh6", "bvh6"), ("input-bvh32", "bvh32")] {
        let view = "--size 64x48 --eye 1,2,3 --target 0,0,0 --json";
        let ours: Value = serde_json::from_str(&desk.run(&format!("simulate ball.lod --method {of_input} {view}"))).unwrap();
        let theirs: Value = serde_json::from_str(&desk.run(&format!("simulate whole.lod --method {of_finest} {view}"))).unwrap();
        assert_eq!(figures(&ours), figures(&theirs), "{of_input}");
        assert_eq!((&ours["setup"]["method"]["name"], &ours["setup"]["scene"]["levels"]), (&of_input.into(), &3.into()));
    }
}

#[test]
fn the_mesh_is_found_by_name_and_hash_or_named() {
    let desk = desk();
    let shot = "simulate ball.lod --method input-bvh --size 16x12";
    let here = desk.json(shot);
    desk.run("build ball.obj --levels 3 -o other.lod");
    std::fs::create_dir(desk.path("away")).unwrap();
    std::fs::rename(desk.path("ball.obj"), desk.path("away/mesh.obj")).unwrap();
    desk.refused(shot, FAILS, &["--method input-bvh", "ball.lod was built from ball.obj", "name it with --mesh"]);
    assert_eq!(figures(&desk.json(&format!("{shot} --mesh away/mesh.obj"))), figures(&here));
    // Its format is known, whatever it is called.
    std::fs::copy(desk.path("away/mesh.obj"), desk.path("mesh.data")).unwrap();
    assert_eq!(figures(&desk.json(&format!("{shot} --mesh mesh.data"))), figures(&here));
    desk.run("build mesh.data --format obj --levels 3 -o data.lod");
    assert_eq!(figures(&desk.json("simulate data.lod --method input-bvh --size 16x12")), figures(&here));
    // Another mesh of that name is not it.
    desk.write("ball.obj", &mesh(0.06));
    desk.refused(shot, FAILS, &["that very file is neither beside it"]);
    desk.refused(&format!("{shot} --mesh ball.obj"), FAILS, &["none of --mesh"]);
    desk.run("generate sphere --levels 2 -o made.lod");
    desk.refused("simulate made.lod --method input-bvh --size 16x12", FAILS, &["made.lod", "was not built from a mesh file"]);
    desk.refused("cast ball.lod rays.npy --method input-bvh -o hits.npy", USAGE, &["input-bvh"]);
}

#[test]
fn a_mesh_is_the_same_with_the_files_that_belong_to_it() {
    let desk = desk();
    desk.write("red.obj", &format!("mtllib red.mtl\nusemtl red\n{}", mesh(0.05)));
    desk.write("red.mtl", "newmtl red\nKd 1 0 0\n");
    desk.refused("build red.obj --levels 3 -o red.mtl", FAILS, &["cannot write red.mtl: it is the input file"]);
    desk.run("build red.obj --levels 3 -o red.lod");
    let shot = "simulate red.lod --method input-bvh --size 16x12";
    desk.run(shot);
    desk.write("red.mtl", "newmtl red\nKd 0 1 0\n");
    desk.refused(shot, FAILS, &["red.lod was built from red.obj, and that very file, with the files that belong to it, is neither"]);
}

#[test]
fn a_sweep_does_not_keep_what_it_measured_of_another_surface() {
    let desk = desk();
    let list = "size = \"32x32\"\ndistances = [3]\nmethods = [\"lod\", \"cluster\"]\n[[scene]]\nfile = \"ball.lod\"\n[[machine]]\nname = \"haydel2023\"\n";
    desk.write("list.toml", list);
    std::fs::rename(desk.path("ball.obj"), desk.path("mesh.obj")).unwrap();
    let run = |words: &str| {
        let (code, said) = desk.hear(&format!("sweep list.toml -o out {words}"));
        assert_eq!(code, 0, "{said}");
        said
    };
    let last = |said: &str| said.lines().find(|line| line.starts_with("2 jobs, ")).unwrap().to_owned();
    assert!(last(&run("")).starts_with("2 jobs, 0 of them done before"));
    // Clusters are of the mesh now; ours is what it was.
    assert!(last(&run("--mesh mesh.obj")).starts_with("2 jobs, 1 of them done before"));
    assert!(last(&run("--mesh mesh.obj")).starts_with("2 jobs, 2 of them done before"));
}

#[test]
fn errors_are_against_the_input_where_it_is_at_hand() {
    let desk = desk();
    let measured = |out: &str, words: &str| -> Value {
        let (code, said) =
            desk.hear(&format!("error-time ball.lod -o {out} --quick --size 96x96 --distances 2 --most-samples 0 --no-host {words}"));
        assert_eq!(code, 0, "{said}");
        serde_json::from_str(&desk.text(&format!("{out}/error-time.json"))).unwrap()
    };
    let with = measured("with", "");
    let points = with["points"].as_array().unwrap();
    let of = |method: &str| points.iter().filter(|point| point["method"] == *method).collect::<Vec<_>>();
    // Those at a pole have no area.
    assert_eq!(with["scenes"][0]["input_triangles"], 2016);
    // The input is its own full resolution but for rounding; the finest level is not the input.
    let most = |point: &Value, against: &str| point[against]["surface"]["maximum"].as_f64().unwrap();
    for point in of("input-bvh") {
        assert!(most(point, "geometry") < 1e-3 && point["finest"].is_null(), "{point}");
    }
    for point in of("bvh") {
        assert!(most(point, "geometry") > 10.0 * most(point, "finest"), "{point}");
    }
    assert!(!of("lod").is_empty() && of("lod").iter().all(|point| !point["finest"].is_null()));
    let mesh = desk.text("ball.obj");
    std::fs::remove_file(desk.path("ball.obj")).unwrap();
    let without = measured("without", "");
    let points = without["points"].as_array().unwrap();
    assert!(points.iter().all(|point| point["finest"].is_null() && !point["method"].as_str().unwrap().starts_with("input")));
    assert!(without["scenes"][0]["input_triangles"].is_null());
    let (code, said) = desk.hear("error-time ball.lod -o named --quick --methods lod,input-bvh --no-host");
    assert!(code != 0 && said.contains("that very file is neither beside it"), "{said}");
    // A run that goes on does not keep what it measured before the mesh was there.
    std::fs::write(desk.path("ball.obj"), mesh).unwrap();
    assert_eq!(measured("without", "")["scenes"][0]["input_triangles"], 2016);
}

#[test]
fn lines_of_bvhs_over_the_mesh_stand_beside_those_over_the_finest_level() {
    let desk = desk();
    let rows = |words: &str| -> Value {
        let (code, said) = desk.hear(&format!("lines ball.lod --distances 2 --size 32x32 --json {words}"));
        assert_eq!(code, 0, "{said}");
        serde_json::from_str(&said).unwrap()
    };
    let with = rows("");
    let names: Vec<_> = with["rows"].as_array().unwrap().iter().map(|row| row["structure"].as_str().unwrap().to_owned()).collect();
    assert_eq!(names.iter().filter(|name| name.contains(" of the mesh, ")).count(), 3, "{names:?}");
    assert_eq!(names.len(), 8);
    // Nearly those of a scene that is the mesh: its box is a little another, and so is the eye's place.
    let lines = |report: &Value, name: &str| {
        let row = report["rows"].as_array().unwrap().iter().find(|row| row["structure"] == name).cloned();
        row.unwrap_or_else(|| panic!("no {name}"))["distinct_lines"][0].as_f64().unwrap()
    };
    desk.run("build ball.obj --levels 0 --base 100000 --vertices exact -o whole.lod");
    std::fs::remove_file(desk.path("ball.obj")).unwrap();
    let own: Value = serde_json::from_str(&desk.hear("lines whole.lod --distances 2 --size 32x32 --json --quiet").1).unwrap();
    for size in [4, 8, 16] {
        let (with, own) = (
            lines(&with, &format!("BVH 5-bit of the mesh, Block, {size} a leaf")),
            lines(&own, &format!("BVH 5-bit, Block, {size} a leaf")),
        );
        assert!((with / own - 1.0).abs() < 0.05, "{size}: {with}, {own}");
    }
    assert!(with["ratio_of_mesh"][0].as_f64().unwrap() > 0.0 && own["ratio_of_mesh"].is_null());
}
