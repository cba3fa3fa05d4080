//! The machine that is simulated: cores, caches, crossbar, traversal units and memory, read from `machines/*.toml`.
//!
//! Every figure there bears its source. Unknown keys and impossible values are errors that name the file and the key. The device of the memory
//! (`[dram] device`) and the energies (`[energy]`) are files of their own, named by the machine and read with [`Machine::read`].

mod error;
mod files;
mod parts;
mod validate;

#[cfg(test)]
mod tests;

pub use error::MachineError;
pub use parts::{Cache, Cores, Crossbar, Index, Memory, Tables, Units};

pub(crate) use error::{Breach, LineFault};

use files::Folder;
use serde::{Deserialize, Serialize};
use std::path::Path;
use toml::{Table, Value};

/// A machine.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Machine {
    /// What to call it in reports.
    pub name: String,
    /// Cores.
    pub cores: Cores,
    /// The cache of a group.
    pub l1: Cache,
    /// The cache of all groups.
    pub l2: Cache,
    /// Between the two.
    pub crossbar: Crossbar,
    /// Traversal units.
    pub units: Units,
    /// Memory.
    pub dram: Memory,
    /// Energy tables.
    pub energy: Tables,
    #[serde(skip)]
    folder: Folder,
}

impl Machine {
    /// Reads and checks a description.
    ///
    /// # Errors
    /// It cannot be read, is not TOML, lacks a key or has an unknown one, or a value is impossible.
    pub fn load(file: &Path) -> Result<Self, MachineError> {
        let folder = Folder::Path(file.parent().unwrap_or(Path::new("")).to_owned());
        Self::parse(&files::read(file)?, &file.display().to_string(), folder)
    }

    /// A machine that comes with the program, by name.
    ///
    /// # Errors
    /// There is none of that name.
    pub fn shipped(name: &str) -> Result<Self, MachineError> {
        let (text, file) = Folder::Shipped.read(&format!("{name}.toml"))?;
        Self::parse(&text, &file, Folder::Shipped)
    }

    /// The names that [`Machine::shipped`] knows.
    pub fn all_shipped() -> Vec<&'static str> {
        files::machines().collect()
    }

    /// The text of a file that the machine names, relative to its own, and what to call it in errors. What is not there is taken from the program.
    ///
    /// # Errors
    /// It cannot be read, or is nowhere.
    pub fn read(&self, path: &str) -> Result<(String, String), MachineError> {
        self.folder.read(path)
    }

    /// Changes the value of a dotted key, such as `l1.bytes`; the same checks as for a file. On an error the machine stays as it was.
    ///
    /// # Errors
    /// No such key, a value of the wrong type, or an impossible one.
    pub fn set(&mut self, key: &str, value: &str) -> Result<(), MachineError> {
        self.set_all(&[(key, value)])
    }

    /// Changes the values of several keys at once: only together need they be possible. On an error the machine stays as it was.
    ///
    /// # Errors
    /// No such key, a value of the wrong type, or an impossible one.
    pub fn set_all(&mut self, changes: &[(&str, &str)]) -> Result<(), MachineError> {
        let mut changed = self.clone();
        changes.iter().try_for_each(|(key, value)| changed.replace(key, value))?;
        let all = || changes.iter().map(|(key, value)| format!("{key} = {value}")).collect::<Vec<_>>().join(", ");
        changed.validate().map_err(|breach| breach.in_file(&all()))?;
        *self = changed;
        Ok(())
    }

    /// Changes a value, possible or not.
    fn replace(&mut self, key: &str, value: &str) -> Result<(), MachineError> {
        let wrong = |why: String| MachineError::Override { key: key.to_owned(), value: value.to_owned(), why };
        let mut root = Table::try_from(&*self).map_err(|error| wrong(error.to_string()))?;
        let (path, leaf) = key.rsplit_once('.').unwrap_or(("", key));
        let parts = names(root.iter().filter(|(_, value)| value.is_table()));
        let mut table = &mut root;
        for part in path.split('.').filter(|part| !part.is_empty()) {
            let inner = table.get_mut(part).and_then(Value::as_table_mut);
            table = inner.ok_or_else(|| wrong(format!("the machine has no [{path}]; it has {parts}")))?;
        }
        // A key that is not there is optional, of which all are strings, or unknown, which reading it back tells.
        let parsed = match table.get(leaf) {
            Some(Value::Integer(_)) => {
                let whole = value.parse().ok().filter(|value| *value >= 0);
                Value::Integer(whole.ok_or_else(|| wrong("the value must be an integer, 0 or more".to_owned()))?)
            }
            Some(Value::Table(inner)) => {
                return Err(wrong(format!("a table, not a value; its values are {}", names(inner.iter()))));
            }
            // Nothing that can be left out is a text that says so.
            _ => value.parse().map_or_else(|_| Value::String(value.to_owned()), Value::Boolean),
        };
        table.insert(leaf.to_owned(), parsed);
        let changed: Self = root.try_into().map_err(|error: toml::de::Error| wrong(error.message().to_owned()))?;
        *self = Self { folder: std::mem::take(&mut self.folder), ..changed };
        Ok(())
    }

    fn parse(text: &str, file: &str, folder: Folder) -> Result<Self, MachineError> {
        let machine: Self = from_toml(text, file)?;
        machine.validate().map_err(|breach| breach.in_file(file))?;
        Ok(Self { folder, ..machine })
    }
}

/// Some of a table's keys.
fn names<'a>(entries: impl Iterator<Item = (&'a String, &'a Value)>) -> String {
    entries.map(|(key, _)| key.as_str()).collect::<Vec<_>>().join(", ")
}

/// The contents of a TOML file.
pub(crate) fn from_toml<T: for<'a> Deserialize<'a>>(text: &str, file: &str) -> Result<T, MachineError> {
    toml::from_str(text).map_err(|source| MachineError::Toml { file: file.to_owned(), source: Box::new(source) })
}
