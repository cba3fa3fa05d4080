//! A workflow for Snakemake: a rule whose jobs are the shards, and one that merges.

use super::plan::Plan;

/// Names and texts.
///
/// Files of results are not outputs of a rule: Snakemake removes those of a rule that fails, and what a shard had finished would be done again. Empty files stand for what
/// is done; they are older than the inputs if those have changed, and shards then look for what is left.
pub fn files(plan: &Plan<'_>) -> Vec<(&'static str, String)> {
    let Plan { args, folder, program, command, results, inputs } = plan;
    let (shards, cpus) = (args.shards, args.cpus);
    let done = |name: &str| literal(&format!("{}/done/{name}", braced(folder)));
    let inputs: Vec<_> = inputs.iter().map(|input| literal(&braced(input))).collect();
    let shard = format!("{} --quiet --threads {{threads}} {} --shard {{wildcards.shard}}/{shards}", braced(program), braced(command));
    let merge = format!("{} --quiet merge {}", braced(program), braced(results));
    let text = format!(
        r#"# Shards of: {command}
# On this computer: snakemake -s FOLDER/Snakefile --cores {cpus}. On Slurm: snakemake -s FOLDER/Snakefile --executor slurm --jobs {shards} (with snakemake-executor-plugin-slurm).
# Run it from the folder in which this file was written.


rule all:
    input: {merged}


rule shard:
    input: {inputs}
    output: touch({flag})
    wildcard_constraints: shard=r"\d+"
    threads: {cpus}
    retries: 3
    resources: mem_mb={memory}, runtime={minutes}
    shell: {shard}


rule merge:
    input: expand({flag}, shard=range(1, {next}))
    output: touch({merged})
    resources: mem_mb={memory}, runtime={minutes}
    shell: {merge}
"#,
        merged = done(&format!("merged-of-{shards}")),
        flag = done(&format!("{{shard}}-of-{shards}")),
        inputs = inputs.join(", "),
        memory = args.memory,
        minutes = args.minutes,
        next = shards + 1,
        shard = literal(&shard),
        merge = literal(&merge),
    );
    vec![("Snakefile", text)]
}

/// Text in which braces stand for themselves.
fn braced(text: &str) -> String {
    text.replace('{', "{{").replace('}', "}}")
}

/// A text of Python, which writes plain characters as JSON does.
fn literal(text: &str) -> String {
    serde_json::Value::from(text).to_string()
}
