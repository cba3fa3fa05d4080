//! Where descriptions and the tables that they name lie.

use super::error::MachineError;
use crate::sim::dram::device::PRESETS;
use std::fs;
use std::path::{Path, PathBuf};

/// What comes with the program: path below `machines`, and text; the devices of `machines/dram` are the DRAM model's own.
const SHIPPED: [(&str, &str); 12] = [
    ("haydel2023.toml", include_str!("../../machines/haydel2023.toml")),
    ("haydel2023-ddr3.toml", include_str!("../../machines/haydel2023-ddr3.toml")),
    ("haydel2023-mshr4.toml", include_str!("../../machines/haydel2023-mshr4.toml")),
    ("haydel2023-public.toml", include_str!("../../machines/haydel2023-public.toml")),
    ("packet.toml", include_str!("../../machines/packet.toml")),
    ("turing2018.toml", include_str!("../../machines/turing2018.toml")),
    ("energy/cacti22.toml", include_str!("../../machines/energy/cacti22.toml")),
    ("energy/cacti22.csv", include_str!("../../machines/energy/cacti22.csv")),
    ("energy/cacti22-older.toml", include_str!("../../machines/energy/cacti22-older.toml")),
    ("energy/cacti22-large.toml", include_str!("../../machines/energy/cacti22-large.toml")),
    ("energy/relative.toml", include_str!("../../machines/energy/relative.toml")),
    ("energy/blocks22.toml", include_str!("../../machines/energy/blocks22.toml")),
];

/// Where a machine's files lie.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Folder {
    /// In the program.
    #[default]
    Shipped,
    /// In a folder, or in the program if not there.
    Path(PathBuf),
}

impl Folder {
    /// The text of a file, and what to call it in errors.
    pub fn read(&self, path: &str) -> Result<(String, String), MachineError> {
        if let Self::Path(folder) = self {
            let file = folder.join(path);
            if file.exists() || shipped(path).is_err() {
                return Ok((read(&file)?, file.display().to_string()));
            }
        }
        Ok((shipped(path)?.to_owned(), path.to_owned()))
    }
}

/// The text of a file.
pub fn read(file: &Path) -> Result<String, MachineError> {
    fs::read_to_string(file).map_err(|source| MachineError::Read { file: file.display().to_string(), source })
}

/// The names of the machines that come with the program.
pub fn machines() -> impl Iterator<Item = &'static str> {
    SHIPPED.iter().filter_map(|(path, _)| path.strip_suffix(".toml").filter(|name| !name.contains('/')))
}

/// The text of a file that comes with the program.
fn shipped(path: &str) -> Result<&'static str, MachineError> {
    let devices = PRESETS.map(|(name, text)| (format!("dram/{name}.toml"), text));
    let files = || SHIPPED.iter().copied().chain(devices.iter().map(|(path, text)| (path.as_str(), *text)));
    files().find(|file| file.0 == path).map(|file| file.1).ok_or_else(|| {
        let folder = |path: &str| path.rsplit_once('/').map_or(String::new(), |(folder, _)| folder.to_owned());
        let beside = files().filter(|file| folder(file.0) == folder(path));
        MachineError::NotShipped { name: path.to_owned(), known: beside.map(|file| file.0).collect::<Vec<_>>().join(", ") }
    })
}
