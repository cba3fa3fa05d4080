//! The cache of full-resolution BVHs, which take seconds to build: a folder of files that may be deleted at any time.
//!
//! A file is named by all that its tree depends on, written under another name and renamed, and checked when read: one that is damaged, cut off or of
//! another program is made again. Nothing but files of such names is ever removed.

use super::output::warn;
use anyhow::{Context, ensure};
use etcetera::BaseStrategy;
use lodray::bvh::BvhError;
use lodray::format::{remove_abandoned, write_and_rename};
use lodray::method::bvh::{FullTree, TreeKey, TreeStore};
use std::cell::Cell;
use std::fs::{self, DirEntry, File};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

/// Trees of fewer triangles are built in two hundredths of a second, at three million triangles a second.
const LEAST_TRIANGLES: u64 = 1 << 16;
/// Bytes of all files together; beyond, those go that were not used for longest.
const MOST_BYTES: u64 = 4_000_000_000;
const ENDING: &str = ".lodray-bvh";

#[derive(clap::Args, Clone, Debug)]
pub struct CacheArgs {
    /// Folder that keeps full-resolution BVHs of 65,536 triangles or more for later runs, safe to delete, up to 4 GB; "none" keeps nothing (default:
    /// lodray in the system's folder for caches)
    #[arg(long = "cache", id = "cache", env = "LODRAY_CACHE", value_name = "DIR", hide_env_values = true)]
    folder: Option<PathBuf>,
}

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
    wanted: Cell<u32>,
    read: Cell<u32>,
}

impl<'a> Lookup<'a> {
    /// Nothing wanted yet.
    pub fn new(cache: &'a Cache) -> Self {
        Self { cache, wanted: Cell::new(0), read: Cell::new(0) }
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
        let Found { tree, read } = self.cache.tree(key, triangles, build)?;
        self.wanted.set(self.wanted.get() + 1);
        self.read.set(self.read.get() + u32::from(read));
        Ok(tree)
    }
}

/// An absolute path without links, as far as it exists.
fn real(path: &Path) -> PathBuf {
    let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let mut parents = path.ancestors().filter_map(|parent| Some((parent, parent.canonicalize().ok()?)));
    let below = |(parent, real): (&Path, PathBuf)| path.strip_prefix(parent).map(|rest| real.join(rest)).ok();
    parents.next().and_then(below).unwrap_or_else(|| path.clone())
}

impl Cache {
    /// No cache.
    pub const NONE: Self = Self { folder: None };

    /// The folder that was named, or the usual one, which is made when there is something to keep; without a place for that, none. It is not within `out`, the
    /// run's own folder.
    pub fn new(args: &CacheArgs, out: Option<&Path>) -> anyhow::Result<Self> {
        let folder = match &args.folder {
            Some(named) if named.as_os_str() == "none" => None,
            Some(named) => {
                if let Some(out) = out {
                    let is_within = real(named).starts_with(real(out));
                    ensure!(!is_within, "--cache: {} is within {}, which holds what this run makes", named.display(), out.display());
                }
                fs::create_dir_all(named).with_context(|| format!("--cache: cannot make folder {}", named.display()))?;
                Some(named.clone())
            }
            None => etcetera::base_strategy::choose_native_strategy().ok().map(|places| places.cache_dir().join("lodray")),
        };
        Ok(Self { folder })
    }

    /// The tree of `key` over so many triangles: from the cache if it is there, else built, and kept.
    fn tree(
        &self,
        key: &dyn Fn() -> TreeKey,
        triangles: u64,
        build: &mut dyn FnMut() -> Result<FullTree, BvhError>,
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
            warn(&format!("warning: the BVH is not kept: cannot write {}: {error}", path.display()));
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
    use crate::cli::output::grouped;
    use std::time::Duration;

    #[test]
    fn the_help_names_what_is_too_small_to_keep() {
        let command = <CacheArgs as clap::Args>::augment_args(clap::Command::new("any"));
        let help = command.get_arguments().find(|argument| argument.get_id() == "cache").and_then(clap::Arg::get_help).unwrap().to_string();
        assert!(help.contains(&format!("of {} triangles or more", grouped(LEAST_TRIANGLES))), "{help}");
    }

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
