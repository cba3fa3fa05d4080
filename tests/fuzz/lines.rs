//! Lines of results: as a report reads them, and as a sweep that goes on does.

use super::damage::File;
use super::round::{Limit, folder, round};
use lodray::machine::Machine;
use lodray::rays::{Camera, ModelSpace, View};
use lodray::report::page::{Documents, page};
use lodray::report::results_version;
use lodray::run::Compute;
use lodray::scene::PassRays;
use lodray::study::{JobLines, Row, Silent, aside, csv, results};
use lodray_test_support::models::{scene_of, terrain};
use std::fs;

/// A result alone, a list of two, and lines of a sweep.
fn corpus() -> Vec<File> {
    let scene = scene_of(&terrain(2, 2, 0.6, 5));
    let space = ModelSpace::of(&scene);
    let machine = Machine::shipped("haydel2023").unwrap();
    let result = |name: &str, compute| {
        let view = View { distance: Some(2.0), ..View::default() };
        let camera = Camera::new(&view, &space, 8, 8).unwrap();
        scene.method(name).unwrap().simulate(PassRays::Camera(camera), &machine, "haydel2023", compute).unwrap()
    };
    let results = [result("lod", Compute::Units), result("bvh", Compute::Free)];
    let row = |(k, result): (usize, _)| {
        let row = Row {
            key: format!("job {k} #0123456789abcdef {}", results_version()),
            scene: "terrain".to_owned(),
            result,
            image: None,
            error: None,
        };
        serde_json::to_string(&row).unwrap() + "\n"
    };
    let mut lines: String = results.iter().cloned().map(Some).enumerate().map(row).collect();
    lines += "{\"key\":\"failed #0123456789abcdef 0.1.0\",\"scene\":\"terrain\",\"error\":\"no reason\"}\n";
    vec![
        File::new("alone", serde_json::to_string(&results[0]).unwrap()),
        File::new("list", serde_json::to_string_pretty(&results).unwrap()),
        File::new("lines", lines),
    ]
}

#[test]
fn results_of_jobs() {
    let path = folder().join("results.jsonl");
    // The page that is made of them has a program of a few hundred thousand bytes in it.
    round("results", corpus, Limit { bytes: 8 << 20, each: 200 }, |bytes| {
        fs::write(&path, bytes).unwrap();
        let mut rows = JobLines::<Row>::open(&path, &Silent).unwrap();
        let keys: Vec<_> = rows.done().into_iter().collect();
        assert_eq!(csv(rows.of(&keys)).lines().next().map(|head| head.starts_with("scene,")), Some(true));
        let again = Row { key: "again".to_owned(), scene: String::new(), result: None, image: None, error: None };
        rows.add(again).unwrap();
        aside(&path).iter().filter(|path| path.exists()).for_each(|path| fs::remove_file(path).unwrap());
        match results(&String::from_utf8_lossy(bytes), "results.jsonl", &Silent) {
            Ok(found) => {
                let simulations = found.into_iter().flatten().collect();
                assert!(page(&Documents { simulations, ..Documents::default() }).unwrap().contains("</html>"));
                true
            }
            Err(error) => {
                assert!(error.to_string().starts_with("line ") && error.to_string().len() < 1000, "{error}");
                false
            }
        }
    });
}
