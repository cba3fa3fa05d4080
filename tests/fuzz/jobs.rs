//! Lists of jobs, read by the program: `cluster` reads and splits a list, and runs nothing. The system holds the program to a limit of memory and time.

use super::damage::File;
use super::round::{Limit, round};
use lodray_test_support::program::FAILS;
use std::fs;
use std::process::Command;

/// Kilobytes of addresses that the program may have: its own, its threads', and what it makes of a list.
const KILOBYTES: u32 = 1 << 20;
/// Seconds of processor time.
const SECONDS: u32 = 15;

fn corpus() -> Vec<File> {
    let list = fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/docs/jobs-example.toml")).unwrap();
    [vec![File::new("example", list)], File::all("jobs", "toml")].concat()
}

#[test]
fn lists_of_jobs() {
    let folder = tempfile::tempdir().unwrap();
    let program = assert_cmd::cargo::cargo_bin!("lodray");
    // Of this program's memory, which starts that one.
    round("jobs", corpus, Limit { bytes: 1 << 20, each: 100 }, |bytes| {
        fs::write(folder.path().join("jobs.toml"), bytes).unwrap();
        let script = format!(
            "ulimit -v {KILOBYTES}; ulimit -t {SECONDS}; exec \"$0\" cluster snakemake --shards 2 --force -o engine -- sweep jobs.toml -o out"
        );
        let mut command = Command::new("sh");
        command.arg("-c").arg(script).arg(program).current_dir(folder.path()).env("RAYON_NUM_THREADS", "1").env("LODRAY_CACHE", "none");
        let output = command.output().unwrap();
        let said = String::from_utf8_lossy(&output.stderr);
        match output.status.code() {
            Some(0) => true,
            Some(FAILS) => {
                assert!(said.starts_with("error: ") && said.lines().count() == 1 && said.len() < 2000, "{said}");
                false
            }
            code => panic!("{code:?}: {said}"),
        }
    });
}
