//! The program in a folder of its own, as a user runs it.

use npyz::WriterBuilder;
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Exit codes.
pub const FAILS: i32 = 1;
pub const USAGE: i32 = 2;

/// Writes a file of rays, of so many columns.
pub fn write_rays(path: &Path, columns: u64, rows: &[f64]) {
    let file = fs::File::create(path).unwrap();
    let shape = [rows.len() as u64 / columns, columns];
    let mut writer = npyz::WriteOptions::new().default_dtype().shape(&shape).writer(file).begin_nd().unwrap();
    writer.extend(rows.iter()).unwrap();
    writer.finish().unwrap();
}

/// A folder that goes away with it, and the program to run there. No BVH is kept for later.
pub struct Desk {
    folder: tempfile::TempDir,
    program: PathBuf,
}

impl Desk {
    /// An empty folder; `program` is `assert_cmd::cargo::cargo_bin!("lodray")`, which only a test of the program's own package knows.
    pub fn new(program: impl Into<PathBuf>) -> Desk {
        Desk { folder: tempfile::tempdir().unwrap(), program: program.into() }
    }

    pub fn folder(&self) -> &Path {
        self.folder.path()
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder().join(name)
    }

    pub fn write(&self, name: &str, text: &str) {
        fs::write(self.path(name), text).unwrap();
    }

    pub fn bytes(&self, name: &str) -> Vec<u8> {
        fs::read(self.path(name)).unwrap()
    }

    pub fn text(&self, name: &str) -> String {
        String::from_utf8(self.bytes(name)).unwrap()
    }

    /// All files in `folder` with their contents.
    pub fn files(&self, folder: &str) -> BTreeMap<String, Vec<u8>> {
        let entries = fs::read_dir(self.path(folder)).unwrap().map(|e| e.unwrap());
        entries.map(|e| (e.file_name().into_string().unwrap(), fs::read(e.path()).unwrap())).collect()
    }

    /// Runs it with `args`, `threads` of 0 being as many as there are cores; gives exit code, standard output and standard error.
    pub fn run_on(&self, threads: u32, args: &str) -> (i32, String, String) {
        let mut command = Command::new(&self.program);
        command.current_dir(self.folder()).args(args.split_whitespace());
        let output = command.env("RAYON_NUM_THREADS", threads.to_string()).env("LODRAY_CACHE", "none").output().unwrap();
        let [out, err] = [output.stdout, output.stderr].map(|text| String::from_utf8(text).unwrap());
        assert!(!err.contains("panicked"), "{args}: {err}");
        (output.status.code().unwrap(), out, err)
    }

    /// Exit code, and everything said.
    pub fn hear(&self, args: &str) -> (i32, String) {
        let (code, out, err) = self.run_on(0, args);
        (code, out + &err)
    }

    /// Runs, expects success and silence on standard error.
    pub fn run(&self, args: &str) -> String {
        let (code, out, err) = self.run_on(0, args);
        assert_eq!((code, err.as_str()), (0, ""), "{args}: {out}");
        out
    }

    /// Runs with `--json`, expects success and one JSON document.
    pub fn json(&self, args: &str) -> Value {
        serde_json::from_str(&self.run(&format!("{args} --json"))).unwrap()
    }

    /// Runs, and expects this exit code and nothing but an error that has all of `words`, in one line unless usage is told.
    pub fn refused(&self, args: &str, code: i32, words: &[&str]) {
        let (got, out, err) = self.run_on(0, args);
        assert_eq!(got, code, "{args}: {err}");
        assert!(err.starts_with("error: ") && words.iter().all(|word| err.contains(word)), "{args}: no {words:?} in: {err}");
        assert!(out.is_empty() && (code == USAGE || err.lines().count() == 1), "{args}: {out}{err}");
    }
}
