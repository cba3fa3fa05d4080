//! Options of the cache of full-resolution BVHs.

use anyhow::{Context, ensure};
use etcetera::BaseStrategy;
use lodray::study::Cache;
use std::fs;
use std::path::{Path, PathBuf};

#[derive(clap::Args, Clone, Debug)]
pub struct CacheArgs {
    /// Folder that keeps full-resolution BVHs of 65,536 triangles or more for later runs, safe to delete, up to 4 GB; "none" keeps nothing (default:
    /// lodray in the system's folder for caches)
    #[arg(long = "cache", id = "cache", env = "LODRAY_CACHE", value_name = "DIR", hide_env_values = true)]
    folder: Option<PathBuf>,
}

/// An absolute path without links, as far as it exists.
fn real(path: &Path) -> PathBuf {
    let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let mut parents = path.ancestors().filter_map(|parent| Some((parent, parent.canonicalize().ok()?)));
    let below = |(parent, real): (&Path, PathBuf)| path.strip_prefix(parent).map(|rest| real.join(rest)).ok();
    parents.next().and_then(below).unwrap_or_else(|| path.clone())
}

impl CacheArgs {
    /// The folder that was named, or the usual one, which is made when there is something to keep; without a place for that, none. It is not within `out`, the
    /// run's own folder.
    pub fn cache(&self, out: Option<&Path>) -> anyhow::Result<Cache> {
        let folder = match &self.folder {
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
        Ok(folder.map_or(Cache::NONE, Cache::of))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use lodray::study::{LEAST_TRIANGLES, grouped};

    #[test]
    fn the_help_names_what_is_too_small_to_keep() {
        let command = <CacheArgs as clap::Args>::augment_args(clap::Command::new("any"));
        let help = command.get_arguments().find(|argument| argument.get_id() == "cache").and_then(clap::Arg::get_help).unwrap().to_string();
        assert!(help.contains(&format!("of {} triangles or more", grouped(LEAST_TRIANGLES))), "{help}");
    }
}
