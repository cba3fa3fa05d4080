//! `verify`: the audit.

use super::output::{busy, open_any, print_json, print_table};
use lodray::format::audit::audit;
use lodray::study::grouped;
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(clap::Args)]
pub struct Args {
    /// Scene file
    scene: PathBuf,
    /// Print the figures as JSON
    #[arg(long)]
    json: bool,
}

pub fn run(args: &Args) -> anyhow::Result<ExitCode> {
    let scene = open_any(&args.scene)?;
    let report = busy("checking", || audit(&scene));
    if args.json {
        print_json(&report)?;
    } else {
        let mut text = format!(
            "displacement bounds: {}\n{:<60}{:>16}{:>16}{:>12}\n",
            report.bounds.name(),
            "check",
            "checked",
            "expected",
            "breaches"
        );
        for check in &report.checks {
            let [checked, expected, breaches] = [check.checked, check.expected, check.breaches].map(grouped);
            text += &format!("{:<60}{checked:>16}{expected:>16}{breaches:>12}\n", check.name);
            if let Some(first) = &check.first {
                text += &format!("  first: {first}\n");
            }
        }
        text += if report.passed() { "passed" } else { "FAILED" };
        print_table(&text)?;
    }
    Ok(if report.passed() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
