//! Chromium, driven by `drive.mjs`.

use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;

/// What was found.
#[derive(Debug, Deserialize)]
pub struct Found {
    pub faults: Vec<String>,
    pub counts: BTreeMap<String, u64>,
    pub ready_ms: f64,
}

/// Modules, node and Chromium, as `scripts/tools` installs them.
fn tools() -> Result<(PathBuf, PathBuf), String> {
    let modules = Path::new(env!("CARGO_MANIFEST_DIR")).join("target/tools/browser");
    if !modules.join("node_modules/playwright-core").exists() || !modules.join("node_modules/axe-core").exists() {
        return Err(format!("{} lacks playwright-core or axe-core", modules.display()));
    }
    if !Command::new("node").arg("--version").output().is_ok_and(|out| out.status.success()) {
        return Err("there is no node".to_owned());
    }
    let given = std::env::var_os("LODRAY_CHROMIUM").map(PathBuf::from);
    let usual = ["/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"].map(PathBuf::from);
    given.into_iter().chain(usual).find(|path| path.exists()).map(|path| (modules, path)).ok_or_else(|| "there is no chromium".to_owned())
}

/// Drives a page; nothing, and a loud line, where the machine has no browser.
pub fn drive(page: &Path, document: Option<&Path>) -> Option<Found> {
    let (modules, chromium) = match tools() {
        Ok(tools) => tools,
        Err(why) => {
            eprintln!("\n*** NOT TESTED: no page was opened in a browser: {why}; scripts/tools installs what is needed ***\n");
            return None;
        }
    };
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/report/drive.mjs");
    let mut command = Command::new("node");
    command.arg(script).arg(modules).arg(chromium).arg(page).arg(document.unwrap_or(Path::new("-")));
    command.args(std::env::var_os("LODRAY_SCREENSHOTS"));
    let output = command.output().unwrap();
    let [out, err] = [output.stdout, output.stderr].map(|text| String::from_utf8_lossy(&text).into_owned());
    let found = out.lines().last().and_then(|line| serde_json::from_str(line).ok());
    Some(found.unwrap_or_else(|| panic!("the browser was not driven to the end: {out}{err}")))
}
