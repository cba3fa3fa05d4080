//! `report`: results as one page that fetches nothing.

mod read;

use super::common::Invocation;
use super::folder::Input;
use super::output::{check_target, remark, write_file};
use anyhow::Context;
use lodray::report::page::{Documents, RunFacts, page};
use lodray::study::grouped;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

#[derive(clap::Args)]
pub struct Args {
    /// Results: of simulate (--json, or result.json), of sweep (results.jsonl), of stability (stability.json), of error-time (error-time.json; several become one, of all their views), and tables of claims (Markdown)
    #[arg(required = true, value_name = "RESULT")]
    results: Vec<PathBuf>,
    /// File for the page (.html)
    #[arg(short, long, value_name = "FILE")]
    out: PathBuf,
    /// The page's title (default: what it shows)
    #[arg(long)]
    title: Option<String>,
}

/// The option of the commands that can write a page of their own results.
#[derive(clap::Args)]
pub struct PageArgs {
    /// Write the results as a page, too (.html): diagrams, tables and how they were run, with nothing to fetch
    #[arg(long = "report", value_name = "FILE")]
    page: Option<PathBuf>,
}

impl PageArgs {
    /// Whether there is to be one.
    pub fn is_wanted(&self) -> bool {
        self.page.is_some()
    }

    /// Refuses a file that cannot be written, or that is one of the inputs, before any work is done.
    pub fn check(&self, inputs: &[&Path]) -> anyhow::Result<()> {
        self.page.as_deref().map_or(Ok(()), |path| check_target(path, inputs))
    }

    /// Its file, if one is wanted.
    pub fn file(&self) -> Option<&Path> {
        self.page.as_deref()
    }

    /// Writes the page, if one is wanted, of `documents`, which the running command has made of `inputs`.
    pub fn write(&self, documents: Documents, inputs: &[&Path]) -> anyhow::Result<()> {
        let Some(path) = &self.page else { return Ok(()) };
        let run = this_run(inputs)?;
        let runs = documents.runs.into_iter().chain([run]).collect();
        save(path, &titled(Documents { runs, ..documents })).map(drop)
    }
}

pub fn run(args: &Args) -> anyhow::Result<ExitCode> {
    let inputs: Vec<_> = args.results.iter().map(PathBuf::as_path).collect();
    check_target(&args.out, &inputs)?;
    let documents = read::documents(&inputs)?;
    let bytes = save(&args.out, &titled(Documents { title: args.title.clone().unwrap_or_default(), ..documents }))?;
    remark(&format!("page in {}, {} kB", args.out.display(), grouped(bytes as u64 / 1000)))?;
    Ok(ExitCode::SUCCESS)
}

/// The run of this process, which has read `inputs`.
pub fn this_run(inputs: &[&Path]) -> anyhow::Result<RunFacts> {
    let Invocation { command, arguments } = Invocation::of_process();
    let inputs = inputs.iter().map(|input| Ok(Input::read(input)?.into())).collect::<anyhow::Result<_>>()?;
    Ok(RunFacts { lodray: lodray::report::results_version(), command, arguments, inputs, notes: Vec::new() })
}

/// Writes the page of `documents`; gives its size in bytes.
pub fn save(path: &Path, documents: &Documents) -> anyhow::Result<usize> {
    let text = page(documents).with_context(|| format!("cannot make {}", path.display()))?;
    write_file(path, &text)?;
    Ok(text.len())
}

/// The same with a title, if it has none: what it shows, and of which scenes.
pub fn titled(documents: Documents) -> Documents {
    if !documents.title.is_empty() {
        return documents;
    }
    let what = match &documents {
        Documents { error_time: Some(_), .. } => "Error against cost",
        Documents { simulations, .. } if !simulations.is_empty() => "Simulations",
        Documents { stability, .. } if !stability.is_empty() => "Stability",
        _ => "Claims, measured",
    };
    let of_documents = documents.error_time.iter().flat_map(|document| document.scenes.iter().map(|scene| scene.name.clone()));
    let of_simulation = |s: &lodray::report::page::Simulation| s.scene.clone().unwrap_or_else(|| s.result.setup.scene.name.clone());
    let mut scenes: Vec<String> = Vec::new();
    for name in of_documents.chain(documents.simulations.iter().map(of_simulation)) {
        if !scenes.contains(&name) {
            scenes.push(name);
        }
    }
    let names = match scenes.as_slice() {
        [] => String::new(),
        few if few.len() <= 4 => format!(": {}", few.join(", ")),
        many => format!(" of {} scenes", many.len()),
    };
    let sizes = documents.error_time.as_ref().map_or_else(String::new, |document| format!(", {}", document.sizes_in_words(None)));
    Documents { title: format!("{what}{names}{sizes}"), ..documents }
}
