//! Output files: written under a temporary name and renamed, so that a half-written file is never found and a failure leaves what was there.
//!
//! A temporary file is locked by its writer as long as that runs; the system lets go of the lock however a program ends. So what has a temporary
//! name and no lock was left by a program that was killed, and [`remove_abandoned`] removes it.

use super::staging;
use std::ffi::OsStr;
use std::fs::{self, File, Metadata, TryLockError};
use std::io::{self, BufWriter, Write};
use std::path::Path;
use std::time::Duration;
use tempfile::NamedTempFile;

const PREFIX: &str = ".lodray-";
const SUFFIX: &str = ".tmp";
/// Where files cannot be locked, what nobody has changed for so long is abandoned.
const ABANDONED_AFTER: Duration = Duration::from_secs(24 * 60 * 60);

/// Writes a file through `fill` under a temporary name beside `path` and renames it. A file that was there keeps its permissions, and a link that names it stays.
///
/// # Errors
/// What `fill` or the file system says, or there is something else than a file; `path` is then untouched and the temporary file gone.
pub fn write_and_rename(path: &Path, fill: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    // A link that leads nowhere is replaced.
    let target = path.canonicalize();
    let (path, there) = match &target {
        Ok(target) => (target.as_path(), Some(fs::metadata(target)?)),
        Err(_) => (path, None),
    };
    if there.as_ref().is_some_and(|there| !there.is_file()) {
        // Renaming a file to the name of a device would take the device away.
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "it is not an ordinary file"));
    }
    let mut out = BufWriter::new(temporary_beside(path)?);
    fill(&mut out)?;
    let file = out.into_inner().map_err(io::IntoInnerError::into_error)?;
    if let Some(there) = there {
        file.as_file().set_permissions(there.permissions())?;
    }
    file.persist(path).map_err(|e| e.error)?;
    Ok(())
}

/// An empty temporary file in the folder of `path`; dropping it removes it.
///
/// # Errors
/// The folder does not exist or cannot be written to.
pub fn temporary_beside(path: &Path) -> io::Result<NamedTempFile> {
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut builder = tempfile::Builder::new();
    builder.prefix(PREFIX).suffix(SUFFIX);
    #[cfg(unix)]
    {
        // Like any new file (the umask applies), not private to its writer.
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    loop {
        let file = builder.tempfile_in(folder).map_err(plain)?;
        match file.as_file().try_lock() {
            // A file system without locks.
            Err(TryLockError::Error(_)) => return Ok(file),
            Ok(()) if file.path().exists() => return Ok(file),
            // Another program found it before it was locked, and takes it for abandoned.
            Ok(()) | Err(TryLockError::WouldBlock) => {}
        }
    }
}

/// Removes the temporary files and folders in `folder` that killed programs have left; those of programs that still run stay, and so does
/// what the system does not let go.
pub fn remove_abandoned(folder: &Path) {
    let Ok(entries) = fs::read_dir(folder) else { return };
    for entry in entries.flatten().filter(|entry| is_temporary(&entry.file_name())) {
        // Of a link, the link itself.
        let (path, Ok(meta)) = (entry.path(), entry.metadata()) else { continue };
        // What cannot be removed is no reason to stop: the next run tries again.
        let _ = if meta.is_dir() { staging::remove_abandoned(&path) } else { remove_unlocked(&path, &meta) };
    }
}

/// Whether a name is one of those that this program gives to temporary files and folders.
fn is_temporary(name: &OsStr) -> bool {
    name.to_str().is_some_and(|name| name.starts_with(PREFIX) && name.ends_with(SUFFIX))
}

fn remove_unlocked(path: &Path, meta: &Metadata) -> io::Result<()> {
    if !meta.is_file() {
        return Ok(());
    }
    let file = File::open(path)?;
    // Held while the file is removed, so that its writer cannot take it meanwhile.
    match file.try_lock() {
        Ok(()) => fs::remove_file(path),
        Err(TryLockError::WouldBlock) => Ok(()),
        Err(TryLockError::Error(_)) if meta.modified()?.elapsed().is_ok_and(|age| age > ABANDONED_AFTER) => fs::remove_file(path),
        Err(TryLockError::Error(_)) => Ok(()),
    }
}

/// The system's error without the temporary file's name, which tells nobody anything.
fn plain(error: io::Error) -> io::Error {
    let text = error.to_string();
    io::Error::new(error.kind(), text.split(" at path ").next().unwrap_or(&text))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_abandoned_files_are_removed() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        let alive = temporary_beside(&path("a")).unwrap();
        for name in [".lodray-gone.tmp", ".lodray-kept", "kept.tmp", "lodray-kept.tmp"] {
            fs::write(path(name), b"x").unwrap();
        }
        let left = || {
            remove_abandoned(folder.path());
            let mut names: Vec<_> = fs::read_dir(folder.path()).unwrap().map(|e| e.unwrap().path()).collect();
            names.sort_unstable();
            names
        };
        let kept = [".lodray-kept", "kept.tmp", "lodray-kept.tmp"].map(path);
        let mut all = kept.to_vec();
        all.push(alive.path().to_owned());
        all.sort_unstable();
        assert_eq!(left(), all);
        // As if its writer were killed now.
        let _ = alive.into_temp_path().keep().unwrap();
        assert_eq!(left(), kept);
    }

    #[test]
    fn a_failure_leaves_the_old_file_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        write_and_rename(&path, |out| out.write_all(b"old")).unwrap();
        let failed = write_and_rename(&path, |out| out.write_all(b"new").and(Err(io::Error::other("full"))));
        assert_eq!(failed.unwrap_err().to_string(), "full");
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
        let none = write_and_rename(&folder.path().join("none/a"), |_| Ok(())).unwrap_err();
        assert!(!none.to_string().contains(".tmp"), "{none}");
    }

    #[cfg(unix)]
    #[test]
    fn what_is_there_stays_what_it_is() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        fs::write(path("file"), b"old").unwrap();
        fs::set_permissions(path("file"), fs::Permissions::from_mode(0o640)).unwrap();
        symlink(path("file"), path("link")).unwrap();
        write_and_rename(&path("link"), |out| out.write_all(b"new")).unwrap();
        assert!(path("link").is_symlink());
        assert_eq!(fs::read(path("file")).unwrap(), b"new");
        assert_eq!(fs::metadata(path("file")).unwrap().permissions().mode() & 0o777, 0o640);
        // Neither a device nor a folder makes way for a file; of links to them the same holds.
        symlink("/dev/null", path("device")).unwrap();
        for other in [path("device"), folder.path().to_owned()] {
            let error = write_and_rename(&other, |_| Ok(())).unwrap_err();
            assert_eq!(error.to_string(), "it is not an ordinary file", "{}", other.display());
        }
        assert!(path("device").is_symlink());
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 3);
    }

    #[cfg(unix)]
    #[test]
    fn files_get_the_permissions_of_any_new_file() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let mode = |name: &str| fs::metadata(folder.path().join(name)).unwrap().permissions().mode();
        fs::write(folder.path().join("plain"), b"").unwrap();
        write_and_rename(&folder.path().join("renamed"), |_| Ok(())).unwrap();
        assert_eq!(mode("plain"), mode("renamed"));
    }
}
