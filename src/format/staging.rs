//! Files of a run before they are where they belong: a temporary folder, which one run at a time has.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

/// A name that [`super::remove_abandoned`] knows.
const NAME: &str = ".lodray-run.tmp";
/// The file in it that its owner locks.
const LOCK: &str = "lock";

/// A folder inside of an output folder, which nobody else has as long as this lives; dropping it removes it with everything in it.
#[derive(Debug)]
pub struct Staging {
    path: PathBuf,
    _lock: File,
}

impl Staging {
    /// The staging folder of `folder`, empty, whatever a killed run may have left there; none if another run has it.
    ///
    /// # Errors
    /// It cannot be made.
    pub fn open(folder: &Path) -> io::Result<Option<Self>> {
        let path = folder.join(NAME);
        let lock = path.join(LOCK);
        // Again whenever a run that just ends has removed what was found.
        loop {
            match fs::create_dir(&path) {
                Err(error) if error.kind() != ErrorKind::AlreadyExists => return Err(error),
                _ => {}
            }
            // A link would lead to files that are somebody else's.
            match fs::symlink_metadata(&path) {
                Ok(meta) if meta.is_dir() => {}
                Ok(_) => return Err(io::Error::new(ErrorKind::AlreadyExists, format!("{NAME} is there and is not a folder"))),
                Err(error) if error.kind() == ErrorKind::NotFound => continue,
                Err(error) => return Err(error),
            }
            let file = match OpenOptions::new().create(true).truncate(false).write(true).open(&lock) {
                Err(error) if error.kind() == ErrorKind::NotFound => continue,
                other => other?,
            };
            match file.try_lock() {
                Ok(()) => {}
                Err(TryLockError::WouldBlock) => return Ok(None),
                // Where files cannot be locked, as on some network drives, two runs at once are not noticed.
                Err(TryLockError::Error(_)) => {}
            }
            let found = same_file::Handle::from_path(&lock).ok();
            if found == Some(same_file::Handle::from_file(file.try_clone()?)?) {
                empty(&path)?;
                return Ok(Some(Self { path, _lock: file }));
            }
        }
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The names of the files in it, in order.
    ///
    /// # Errors
    /// It cannot be read, or a name is not UTF-8.
    pub fn names(&self) -> io::Result<Vec<String>> {
        let name = |entry: io::Result<fs::DirEntry>| {
            entry?.file_name().into_string().map_err(|name| io::Error::other(format!("{} is not UTF-8", name.display())))
        };
        let mut names = fs::read_dir(&self.path)?.map(name).collect::<io::Result<Vec<_>>>()?;
        names.retain(|name| name != LOCK);
        names.sort_unstable();
        Ok(names)
    }
}

impl Drop for Staging {
    fn drop(&mut self) {
        // What cannot be removed, the next run removes.
        let _ = remove(&self.path);
    }
}

/// Removes the staging folder `path` if its run was killed.
pub(super) fn remove_abandoned(path: &Path) -> io::Result<()> {
    match File::open(path.join(LOCK)) {
        Ok(lock) if lock.try_lock().is_ok() => remove(path),
        Ok(_) => Ok(()),
        // The lock is the last file to go: the folder is empty, or a run makes its lock just now.
        Err(_) => fs::remove_dir(path),
    }
}

/// Removes the folder of a lock that is held: that goes last, so that nobody takes over a folder of which something is left.
fn remove(path: &Path) -> io::Result<()> {
    empty(path)?;
    fs::remove_file(path.join(LOCK))?;
    fs::remove_dir(path)
}

/// Removes everything but the lock.
fn empty(path: &Path) -> io::Result<()> {
    for entry in fs::read_dir(path)? {
        let entry = entry?;
        if entry.file_type()?.is_dir() {
            fs::remove_dir_all(entry.path())?;
        } else if entry.file_name() != LOCK {
            fs::remove_file(entry.path())?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_at_a_time() {
        let folder = tempfile::tempdir().unwrap();
        let first = Staging::open(folder.path()).unwrap().unwrap();
        fs::write(first.path().join("image.png"), b"x").unwrap();
        assert!(Staging::open(folder.path()).unwrap().is_none());
        crate::format::remove_abandoned(folder.path());
        assert_eq!(first.names().unwrap(), ["image.png"]);
        drop(first);
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
    }

    #[test]
    fn what_a_killed_run_left_is_gone() {
        let folder = tempfile::tempdir().unwrap();
        let leave = || {
            let path = folder.path().join(NAME);
            fs::create_dir(&path).unwrap();
            fs::write(path.join(LOCK), b"").unwrap();
            fs::write(path.join("image.png"), b"x").unwrap();
        };
        leave();
        assert!(Staging::open(folder.path()).unwrap().unwrap().names().unwrap().is_empty());
        leave();
        crate::format::remove_abandoned(folder.path());
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
    }

    #[test]
    fn many_at_once_share_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let owners = std::sync::atomic::AtomicU32::new(0);
        std::thread::scope(|scope| {
            for _ in 0..4 {
                scope.spawn(|| {
                    for _ in 0..200 {
                        if let Some(staging) = Staging::open(folder.path()).unwrap() {
                            assert_eq!(owners.fetch_add(1, std::sync::atomic::Ordering::SeqCst), 0);
                            fs::write(staging.path().join("a"), b"x").unwrap();
                            assert_eq!(staging.names().unwrap(), ["a"]);
                            owners.fetch_sub(1, std::sync::atomic::Ordering::SeqCst);
                        }
                    }
                });
            }
        });
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
    }
}
