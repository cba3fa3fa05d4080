//! Output files: written under a temporary name and renamed, so that a half-written file is never found and a failure leaves what was there.

use std::io::{self, BufWriter, Write};
use std::path::Path;
use tempfile::NamedTempFile;

/// Writes a file through `fill` under a temporary name beside `path` and renames it.
///
/// # Errors
/// What `fill` or the file system says; `path` is then untouched and the temporary file gone.
pub fn write_and_rename(path: &Path, fill: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    let mut out = BufWriter::new(temporary_beside(path)?);
    fill(&mut out)?;
    let file = out.into_inner().map_err(io::IntoInnerError::into_error)?;
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
    builder.prefix(".lodray-").suffix(".tmp");
    #[cfg(unix)]
    {
        // Like any new file (the umask applies), not private to its writer.
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    builder.tempfile_in(folder).map_err(plain)
}

/// The system's error without the temporary file's name, which tells nobody anything.
fn plain(error: io::Error) -> io::Error {
    let text = error.to_string();
    io::Error::new(error.kind(), text.split(" at path ").next().unwrap_or(&text))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

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
    fn files_get_the_permissions_of_any_new_file() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let mode = |name: &str| fs::metadata(folder.path().join(name)).unwrap().permissions().mode();
        fs::write(folder.path().join("plain"), b"").unwrap();
        write_and_rename(&folder.path().join("renamed"), |_| Ok(())).unwrap();
        assert_eq!(mode("plain"), mode("renamed"));
    }
}
