//! A folder of mesh files for a test.

use lodray::mesh::{TriangleMesh, read};
use std::path::{Path, PathBuf};

pub struct Files(tempfile::TempDir);

impl Files {
    pub fn folder(&self) -> &Path {
        self.0.path()
    }

    pub fn new() -> Files {
        Files(tempfile::tempdir().unwrap())
    }

    pub fn write(&self, name: &str, content: impl AsRef<[u8]>) -> PathBuf {
        let path = self.0.path().join(name);
        std::fs::write(&path, content).unwrap();
        path
    }

    pub fn read(&self, name: &str, content: impl AsRef<[u8]>) -> TriangleMesh {
        read(&self.write(name, content)).unwrap()
    }

    /// The message for a bad file, which must name the file and all of `parts`.
    pub fn refuses(&self, name: &str, content: impl AsRef<[u8]>, parts: &[&str]) {
        let path = self.write(name, content);
        let message = read(&path).expect_err("a bad file was read").to_string();
        assert!(message.contains(path.to_str().unwrap()), "no file name in: {message}");
        assert!(!message.contains('\n'), "more than one line: {message}");
        for part in parts {
            assert!(message.contains(part), "no '{part}' in: {message}");
        }
    }
}
