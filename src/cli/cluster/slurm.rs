//! Files for Slurm: an array of shards, a merge that waits for it, and what hands both in.

use super::plan::Plan;
use super::words::quoted;

/// Names and texts.
pub fn files(plan: &Plan<'_>) -> Vec<(&'static str, String)> {
    vec![("shard.sbatch", shard(plan)), ("merge.sbatch", merge(plan)), ("submit", submit(plan))]
}

/// Lines of options; sbatch reads them to the first command.
fn options(plan: &Plan<'_>, own: &[String]) -> String {
    own.iter().chain(&plan.args.sbatch).map(|option| format!("#SBATCH {option}\n")).collect()
}

/// Where a job's output goes: sbatch reads no quotes of a shell, but its own.
fn log(plan: &Plan<'_>, name: &str) -> String {
    format!("--output=\"{}/logs/{name}.log\"", plan.folder)
}

fn shard(plan: &Plan<'_>) -> String {
    let Plan { args, program, command, .. } = plan;
    let (shards, digits) = (args.shards, args.shards.to_string().len());
    let own = [
        "--job-name=lodray-shards".to_owned(),
        format!("--array=1-{shards}"),
        format!("--cpus-per-task={}", args.cpus),
        format!("--mem={}M", args.memory),
        format!("--time={}", args.minutes),
        // Of a node that fails, its shards are done by others.
        "--requeue".to_owned(),
        "--open-mode=append".to_owned(),
        log(plan, &format!("%{digits}a-of-{shards}")),
    ];
    format!(
        r#"#!/bin/sh
# A shard of: {command}
{options}
set -u
status=0
{program} --quiet --threads {cpus} {command} --shard "$SLURM_ARRAY_TASK_ID/{shards}" || status=$?
# 0: all is well. 1: an error, or a job that failed. 2: wrong usage. Anything else: it was killed, and is tried again, three times at most. What it had finished is not done again.
if [ "$status" -gt 2 ] && [ "${{SLURM_RESTART_COUNT:-0}}" -lt 3 ]; then
  echo "shard $SLURM_ARRAY_TASK_ID/{shards} was killed (status $status), and is tried again"
  scontrol requeue "${{SLURM_ARRAY_JOB_ID}}_$SLURM_ARRAY_TASK_ID" && sleep 60
fi
exit "$status"
"#,
        options = options(plan, &own),
        cpus = args.cpus,
    )
}

fn merge(plan: &Plan<'_>) -> String {
    let Plan { args, program, command, results, .. } = plan;
    let own = [
        "--job-name=lodray-merge".to_owned(),
        "--cpus-per-task=1".to_owned(),
        format!("--mem={}M", args.memory),
        format!("--time={}", args.minutes),
        "--requeue".to_owned(),
        "--open-mode=append".to_owned(),
        log(plan, "merge"),
    ];
    format!(
        "#!/bin/sh
# Puts the shards together of: {command}
{}
exec {program} --quiet --threads 1 merge {results}
",
        options(plan, &own)
    )
}

fn submit(plan: &Plan<'_>) -> String {
    let file = |name: &str| quoted(&format!("{}/{name}", plan.folder));
    format!(
        r#"#!/bin/sh
# Hands in the shards, and their merge, which says what is missing if a shard has failed. Run this from the folder in which the files were written; run it again, and
# only what is left is done.
set -eu
mkdir -p {logs}
shards=$(sbatch --parsable {shard})
shards=${{shards%%;*}}
merge=$(sbatch --parsable --dependency="afterany:$shards" {merge})
echo "shards: job $shards; merge: job ${{merge%%;*}}; what they say: {logs}"
"#,
        logs = file("logs"),
        shard = file("shard.sbatch"),
        merge = file("merge.sbatch"),
    )
}
