//! The cache of full-resolution BVHs, which take seconds to build: a folder of files that may be deleted at any time.
//!
//! A file is named by all that its tree depends on, written under another name and renamed, and checked when read: one that is damaged, cut off or of
//! another program is made again. Nothing but files of such names is ever removed.

use super::progress::Progress;
use crate::bvh::BvhError;
use crate::format::{remove_abandoned, write_and_rename};
use crate::method::bvh::{FullTree, TreeKey, TreeStore};
use std::cell::Cell;
use std::fs::{self, DirEntry, File};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

/// Trees of fewer triangles are built in two hundredths of a second, at three million triangles a second.
pub const LEAST_TRIANGLES: u64 = 1 << 16;
/// Bytes of all files together; beyond, those go that were not used for longest.
const MOST_BYTES: u64 = 4_000_000_000;
const ENDING: &str = ".lodray-bvh";

/// Where full-resolution BVHs are kept, if they are.
pub struct Cache {
    folder: Option<PathBuf>,
}

/// A tree, and whether it came from the cache.
struct Found {
    tree: FullTree,
    read: bool,
}

/// The cache, and whether everything that was wanted of it was there.
pub struct Lookup<'a> {
    cache: &'a Cache,
    progress: &'a dyn Progress,
    wanted: Cell<u32>,
    read: Cell<u32>,
}

impl<'a> Lookup<'a> {
    /// Nothing wanted yet.
    pub fn new(cache: &'a Cache, progress: &'a dyn Progress) -> Self {
        Self { cache, progress, wanted: Cell::new(0), read: Cell::new(0) }
    }

    /// Something was wanted, and all of it was there.
    pub fn was_read(&self) -> bool {
        self.wanted.get() > 0 && self.wanted == self.read
    }
}

impl TreeStore for Lookup<'_> {
    fn tree(
        &self,
        key: &dyn Fn() -> TreeKey,
        triangles: u64,
        build: &mut dyn FnMut() -> Result<FullTree, BvhError>,
    ) -> Result<FullTree, BvhError> {
        let Found { tree, read } = self.cache.tree(key, triangles, build, self.progress)?;
        self.wanted.set(self.wanted.get() + 1);
        self.read.set(self.read.get() + u32::from(read));
        Ok(tree)
    }
}

impl Cache {
    /// No cache.
    pub const NONE: Self = Self { folder: None };

    /// A cache in this folder, which is made when there is something to keep.
    pub fn of(folder: PathBuf) -> Self {
        Self { folder: Some(folder) }
    }

    /// The tree of `key` over so many triangles: from the cache if it is there, else built, and kept.
    fn tree(
        &self,
        key: &dyn Fn() -> TreeKey,
        triangles: u64,
        build: &mut dyn FnMut() -> Result<FullTree, BvhError>,
        progress: &dyn Progress,
    ) -> Result<Found, BvhError> {
        let Some(folder) = self.folder.as_ref().filter(|_| triangles >= LEAST_TRIANGLES) else {
            return Ok(Found { tree: build()?, read: false });
        };
        let key = key();
        let path = folder.join(format!("{key}{ENDING}"));
        if let Some(tree) = read(&path, key, triangles) {
            return Ok(Found { tree, read: true });
        }
        let tree = build()?;
        let kept = fs::create_dir_all(folder).and_then(|()| write_and_rename(&path, |out| tree.write(key, out)));
        if let Err(error) = kept {
            // The run does not depend on it.
            progress.note(&format!("warning: the BVH is not kept: cannot write {}: {error}", path.display()));
        }
        prune(folder, MOST_BYTES);
        Ok(Found { tree, read: false })
    }
}

/// The tree of a file, which then counts as just used.
fn read(path: &Path, key: TreeKey, triangles: u64) -> Option<FullTree> {
    let mut file = File::open(path).ok()?;
    let length = file.metadata().ok().filter(fs::Metadata::is_file)?.len();
    let tree = FullTree::read(key, triangles, length, &mut file)?;
    // A folder that cannot be written to serves as well; its files only grow old.
    if let Ok(writable) = File::options().append(true).open(path) {
        let _ = writable.set_modified(SystemTime::now());
    }
    Some(tree)
}

/// Removes files of trees, those first that were not used for longest, until at most `most` bytes are left, and what killed runs have left.
/// What cannot be read or removed is left: another run may be at it.
fn prune(folder: &Path, most: u64) {
    remove_abandoned(folder);
    let Ok(entries) = fs::read_dir(folder) else { return };
    let facts = |entry: DirEntry| {
        let meta = entry.metadata().ok().filter(fs::Metadata::is_file)?;
        Some((meta.modified().ok()?, entry.path(), meta.len(), entry.file_name().into_string().ok()?))
    };
    let mut trees: Vec<_> = entries.filter_map(|entry| facts(entry.ok()?)).filter(|(.., name)| is_tree(name)).collect();
    trees.sort_unstable();
    let mut bytes: u64 = trees.iter().map(|tree| tree.2).sum();
    for (_, path, size, _) in trees {
        if bytes <= most {
            return;
        }
        if fs::remove_file(path).is_ok() {
            bytes -= size;
        }
    }
}

/// Whether a file of this name is a tree's.
fn is_tree(name: &str) -> bool {
    name.strip_suffix(ENDING).is_some_and(|key| key.len() == 32 && key.bytes().all(|c| c.is_ascii_hexdigit()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[test]
    fn the_longest_unused_go_first_and_nothing_else_goes() {
        let folder = tempfile::tempdir().unwrap();
        let now = SystemTime::now();
        let put = |name: &str, age: u64| {
            fs::write(folder.path().join(name), [0; 100]).unwrap();
            let file = File::options().append(true).open(folder.path().join(name)).unwrap();
            file.set_modified(now - Duration::from_secs(3600 * age)).unwrap();
        };
        let tree = |k: u32| format!("{k:032x}{ENDING}");
        (1..=4).for_each(|k| put(&tree(k), 50 - u64::from(k)));
        let others = ["thesis.tex".to_owned(), format!("mine{ENDING}"), format!("{:032}.tmp", 1)];
        others.iter().for_each(|name| put(name, 1000));
        put(".lodray-left.tmp", 1);
        prune(folder.path(), 200);
        let mut left: Vec<_> = fs::read_dir(folder.path()).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        let mut wanted: Vec<_> = [tree(3), tree(4)].into_iter().chain(others).collect();
        left.sort();
        wanted.sort();
        assert_eq!(left, wanted);
    }
}
