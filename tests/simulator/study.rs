//! Measuring by the library gives what the program gives, and says how far it is.

use lodray::format::Scene;
use lodray::machine::Machine;
use lodray::method::find;
use lodray::report::result::MachineFacts;
use lodray::run::Compute;
use lodray::scene::Target;
use lodray::study::{
    Cache, Chosen, ErrorTimePlan, JobLines, Jobs, Means, Measure, Origin, Progress, Row, SceneJobs, ViewJob, ViewRow, Work, document,
    error_time, sweep,
};
use lodray_test_support::program::Desk;
use serde_json::Value;
use std::path::Path;
use std::sync::Mutex;

/// Keeps what it is told.
#[derive(Default)]
struct Told {
    begun: Mutex<Vec<String>>,
    steps: Mutex<u64>,
}

struct Step<'a>(&'a Told);

impl Progress for Told {
    fn begin(&self, what: &str, _: Option<u64>) -> Box<dyn Work + '_> {
        self.begun.lock().unwrap().push(what.to_owned());
        Box::new(Step(self))
    }

    fn note(&self, line: &str) {
        panic!("{line}");
    }
}

impl Work for Step<'_> {
    fn step(&self, steps: u64) {
        *self.0.steps.lock().unwrap() += steps;
    }

    fn say(&self, _: &str) {}
}

impl Told {
    fn heard(&self, what: &str) -> bool {
        self.begun.lock().unwrap().iter().any(|begun| begun == what)
    }
}

fn with_scene() -> Desk {
    let desk = Desk::new(assert_cmd::cargo::cargo_bin!("lodray"));
    desk.run("generate terrain --levels 2 --base 8 --seed 2 -o a.lod");
    desk
}

/// What `--size 16x16 --distances 4 --methods lod,bvh --machine packet --compute free` asks for.
fn jobs(file: &Path) -> Jobs {
    let scene = SceneJobs { views: vec![ViewJob::at([16, 16], 4.0)], ..SceneJobs::new("a", Origin::File(file.to_owned())) };
    let machine = MachineFacts { label: "packet".to_owned(), set: Vec::new(), description: Machine::shipped("packet").unwrap() };
    let methods = ["lod", "bvh"].map(|name| Chosen::plain(find(name).unwrap())).to_vec();
    Jobs::new(vec![scene], methods, vec![Target { machine, compute: Compute::Free, window: None }])
}

fn line(bytes: &[u8]) -> Value {
    serde_json::from_slice(bytes.split(|&byte| byte == b'\n').next().unwrap()).unwrap()
}

#[test]
fn a_view_is_that_of_error_time() {
    let desk = with_scene();
    desk.run(
        "error-time a.lod -o by-program --size 16x16 --error-size 16 --distances 4 --methods lod,bvh --machine packet --compute free --samples 1 --most-samples 0 --no-host",
    );
    let (told, folder) = (Told::default(), desk.path("by-library"));
    std::fs::create_dir(&folder).unwrap();
    let measure = Measure { host_rays: 0, ..Measure::of(16, 0) };
    let plan = ErrorTimePlan { sides: vec![1], measure, ..ErrorTimePlan::new(jobs(&desk.path("a.lod"))) };
    plan.check().unwrap();
    let mut rows = JobLines::<ViewRow>::open(&folder.join("views.jsonl"), &told).unwrap();
    let means = Means { cache: &Cache::NONE, open: &|scene| Ok(scene.open()?), progress: &told };
    let keys = error_time(&plan, &mut rows, &folder, &|_| false, &means).unwrap();
    let measured: Vec<_> = rows.of(&keys).map(|row| row.measured.as_ref().expect("no failure")).collect();
    let document = document(&plan, &measured);
    assert!(document.points.len() > 3 && document.views.len() == 1 && told.heard("views") && told.heard("settings"));
    assert!(*told.steps.lock().unwrap() > document.points.len() as u64);
    let [program, library] = ["by-program", "by-library"].map(|folder| line(&desk.files(folder)["views.jsonl"])["measured"].clone());
    for part in ["view", "points", "pictures", "sizes"] {
        assert!(!program[part].is_null() && program[part] == library[part], "{part}");
    }
    let picture = program["pictures"][0]["file"].as_str().unwrap();
    assert!(desk.files("by-program")[picture] == desk.files("by-library")[picture]);
    // All is there: nothing is measured again.
    let again = Told::default();
    error_time(&plan, &mut rows, &folder, &|_| false, &Means { open: &|_| panic!("it is opened again"), progress: &again, ..means })
        .unwrap();
    assert_eq!(*again.steps.lock().unwrap(), 0);
}

#[test]
fn a_job_is_that_of_a_sweep_and_what_fails_is_a_row() {
    let desk = with_scene();
    desk.write(
        "jobs.toml",
        "size = \"16x16\"\ndistances = [4]\nmethods = [\"lod\", \"bvh\"]\ncompute = [\"free\"]\n[[scene]]\nfile = \"a.lod\"\n[[machine]]\nname = \"packet\"\n",
    );
    desk.run("sweep jobs.toml -o by-program");
    let (told, jobs) = (Told::default(), jobs(&desk.path("a.lod")));
    let mut rows = JobLines::<Row>::open(&desk.path("results.jsonl"), &told).unwrap();
    let open = |_: &SceneJobs| Err("a reason".into());
    let keys = sweep(&jobs, &mut rows, 1, &Means { cache: &Cache::NONE, open: &open, progress: &told }).unwrap();
    assert!(keys.len() == 2 && rows.of(&keys).all(|row| row.error.as_deref() == Some("a reason")));
    let scene = Scene::open(&desk.path("a.lod")).unwrap();
    let open = |_: &SceneJobs| Ok(scene.clone());
    // A job that failed is not done.
    let mut rows = JobLines::<Row>::open(&desk.path("results.jsonl"), &told).unwrap();
    sweep(&jobs, &mut rows, 2, &Means { cache: &Cache::NONE, open: &open, progress: &told }).unwrap();
    let results: Vec<_> = rows.of(&keys).map(|row| serde_json::to_value(row.result.as_ref().expect("a result")).unwrap()).collect();
    let text = String::from_utf8(desk.files("by-program")["results.jsonl"].clone()).unwrap();
    let program: Vec<Value> = text.lines().map(|line| serde_json::from_str::<Value>(line).unwrap()["result"].clone()).collect();
    assert!(results == program && told.heard("simulating"));
}
