//! Shards: a sweep and an error-time in parts give the bytes of one run, whatever happens to them; the files for engines do what they say.

use lodray_test_support::program::{Desk, FAILS, USAGE};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::{Child, Command, Stdio};

/// 24 jobs in 12 pieces.
const JOBS: &str = "size = \"12x8\"\ndistances = [2, 6]\nmethods = [\"lod\", \"bvh\"]\ndeltas = [1, 2]\n\
    [[scene]]\ngenerate = \"terrain\"\nlevels = 1\nbase = 8\n[[scene]]\ngenerate = \"sphere\"\nlevels = 1\nbase = 8\n\
    [[machine]]\nname = \"haydel2023\"\n[[machine]]\nname = \"packet\"\n";

fn desk() -> Desk {
    let desk = Desk::new(assert_cmd::cargo::cargo_bin!("lodray"));
    desk.write("jobs.toml", JOBS);
    desk
}

/// Files of a folder, without those of folders in it.
fn files(desk: &Desk, folder: &str) -> BTreeMap<String, Vec<u8>> {
    let entries = fs::read_dir(desk.path(folder)).unwrap().map(Result::unwrap).filter(|entry| entry.path().is_file());
    entries.map(|entry| (entry.file_name().into_string().unwrap(), fs::read(entry.path()).unwrap())).collect()
}

/// The names of the jobs in a folder's shards that have a result, and of those that were run, each as often as that happened.
fn jobs(desk: &Desk, folder: &str) -> [Vec<String>; 2] {
    let mut of = [Vec::new(), Vec::new()];
    for (name, bytes) in files(desk, &format!("{folder}/shards")) {
        for line in bytes.split(|&byte| byte == b'\n') {
            let Ok(line) = serde_json::from_slice::<Value>(line) else { continue };
            let Some(key) = line["key"].as_str() else { continue };
            match name.ends_with(".seconds.jsonl") {
                true => of[1].push(key.to_owned()),
                false if line["error"].is_null() => of[0].push(key.to_owned()),
                false => {}
            }
        }
    }
    of
}

/// Each job has one result, and was run once.
fn each_once(desk: &Desk, folder: &str, count: usize) {
    for mut names in jobs(desk, folder) {
        names.sort();
        let all = names.len();
        names.dedup();
        assert_eq!((all, names.len()), (count, count));
    }
}

fn start(desk: &Desk, program: &Path, args: &str) -> Child {
    let mut command = Command::new(program);
    command.current_dir(desk.folder()).args(args.split_whitespace()).env("LODRAY_CACHE", "none");
    command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap()
}

#[test]
fn shards_of_a_sweep_give_the_bytes_of_one_run() {
    let desk = desk();
    desk.run("sweep jobs.toml -o local");
    let local = files(&desk, "local");
    for (shard, done) in [("3/4", 0), ("1/4", 0), ("3/4", 6), ("2/4", 0)] {
        let said = desk.run(&format!("sweep jobs.toml -o out --shard {shard}"));
        assert_eq!(said, format!("shard {shard}: 6 jobs, {done} of them done before, 0 failed; results in out/shards\n"));
    }
    // One is missing, and nothing is written.
    desk.refused("merge out", FAILS, &["out/shards: 6 jobs are not done yet (run shard 4/4); the first is "]);
    assert!(files(&desk, "out").is_empty());
    // The rest is done by shards of another split, which leave alone what is done.
    (1..=5).for_each(|k| drop(desk.run(&format!("sweep jobs.toml -o out --shard {k}/5 --threads 1"))));
    each_once(&desk, "out", 24);
    assert_eq!(desk.run("merge out"), "24 jobs, 0 of them done before, 0 failed; results in out\n");
    assert!(files(&desk, "out") == local);
    assert_eq!(desk.run("merge out --quiet"), "");
    assert!(files(&desk, "out") == local);
    // What the folder's own results have is not done by a shard either.
    fs::remove_dir_all(desk.path("out/shards")).unwrap();
    assert!(desk.run("sweep jobs.toml -o out --shard 1/2").contains("12 jobs, 12 of them done before"));
    // More shards than there is to do; times of the run before.
    desk.run("sweep jobs.toml -o few --shard 1/1");
    for k in 1..=14 {
        desk.run(&format!("sweep jobs.toml -o many --shard {k}/14 --costs few"));
    }
    each_once(&desk, "many", 24);
    desk.run("merge many");
    assert!(files(&desk, "many") == local);
}

#[test]
fn a_killed_shard_goes_on_and_a_full_disk_loses_nothing() {
    let desk = desk();
    desk.run("sweep jobs.toml -o local");
    desk.run("sweep jobs.toml -o out --shard 1/2");
    // Killed while it wrote a line.
    let (part, whole) = (desk.path("out/shards/1-of-2.part.jsonl"), desk.path("out/shards/1-of-2.jsonl"));
    let bytes = fs::read(&whole).unwrap();
    fs::write(&part, &bytes[..bytes.len() - 100]).unwrap();
    fs::remove_file(&whole).unwrap();
    desk.refused("merge out", FAILS, &["13 jobs are not done yet (run shards 1/2, 2/2)"]);
    let (code, said) = desk.hear("sweep jobs.toml -o out --shard 1/2");
    assert!(code == 0 && said.contains("12 jobs, 11 of them done before") && said.contains("is no result: it ends too early"), "{said}");
    assert_eq!(fs::read(&whole).unwrap(), bytes);
    // The disk is full: in the middle of a line, of which nothing is left.
    let program = assert_cmd::cargo::cargo_bin!("lodray");
    let limited = |blocks: u32| {
        let script = format!("trap '' XFSZ; ulimit -f {blocks}; exec \"$0\" sweep jobs.toml -o out --shard 2/2 --at-once 1");
        let output =
            Command::new("sh").args(["-c", &script]).arg(program).current_dir(desk.folder()).env("LODRAY_CACHE", "none").output().unwrap();
        (output.status.code(), String::from_utf8(output.stderr).unwrap())
    };
    let (code, said) = limited(70);
    assert!(code == Some(1) && said.starts_with("error: cannot write out/shards/2-of-2.part.jsonl: "), "{said}");
    let part = desk.text("out/shards/2-of-2.part.jsonl");
    let lines = part.lines().count();
    assert!(part.ends_with('\n') && (2..12).contains(&lines), "{lines}");
    let said = desk.run("sweep jobs.toml -o out --shard 2/2");
    assert!(said.contains(&format!("12 jobs, {lines} of them done before")), "{said}");
    desk.run("merge out");
    assert!(files(&desk, "out") == files(&desk, "local"));
}

#[test]
fn shards_at_once_keep_out_of_each_others_way() {
    let desk = desk();
    desk.run("sweep jobs.toml -o local");
    let program = assert_cmd::cargo::cargo_bin!("lodray");
    let all = [1, 2, 1, 2, 1, 2].map(|k| start(&desk, program, &format!("sweep jobs.toml -o out --shard {k}/2 --threads 1")));
    for child in all {
        let output = child.wait_with_output().unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.success(), "{said}");
        assert!(
            said.lines().all(|line| line.starts_with("note: another run does shard ") && line.ends_with("/2; this one waits for its end")),
            "{said}"
        );
    }
    each_once(&desk, "out", 24);
    desk.run("merge out");
    assert!(files(&desk, "out") == files(&desk, "local"));
}

#[test]
fn jobs_that_fail_are_told_as_by_one_run() {
    let desk = desk();
    // A generated scene has no mesh that it was built from.
    desk.write("fail.toml", &JOBS.replace("\"bvh\"]", "\"input-bvh\"]"));
    let (code, told) = desk.hear("sweep fail.toml -o local");
    assert_eq!((code, told.matches("failed: ").count()), (1, 24), "{told}");
    for _ in 0..2 {
        for k in 1..=2 {
            assert_eq!(desk.hear(&format!("sweep fail.toml -o out --shard {k}/2")).0, 1);
        }
    }
    assert_eq!(desk.hear("merge out"), (1, told.replace("results in local", "results in out")));
    assert!(files(&desk, "out") == files(&desk, "local"));
}

#[test]
fn shards_of_error_time_give_the_bytes_of_one_run() {
    let desk = desk();
    let command = "error-time --jobs jobs.toml --quick --no-host --error-size 8 --most-samples 0";
    desk.run(&format!("{command} -o local --quiet"));
    for k in 1..=3 {
        desk.run(&format!("{command} -o out --shard {k}/3"));
    }
    each_once(&desk, "out", 4);
    desk.run("merge out --quiet");
    let [mut out, mut local] = ["out", "local"].map(|folder| files(&desk, folder));
    // Lines of views have times on the host: how long methods took to build.
    let views = [&mut out, &mut local].map(|files| {
        let text = String::from_utf8(files.remove("views.jsonl").unwrap()).unwrap();
        let parse = |line: &str| -> Value {
            let mut line: Value = serde_json::from_str(line).unwrap();
            line["measured"]["builds"].as_array_mut().unwrap().iter_mut().for_each(|build| build["seconds"] = Value::Null);
            line
        };
        text.lines().map(parse).collect::<Vec<_>>()
    });
    assert_eq!(views[0], views[1]);
    assert!(out.len() > 20 && out == local);
}

#[test]
fn what_cannot_be_split_is_refused() {
    let desk = desk();
    desk.refused("sweep jobs.toml -o out --shard 3/2", USAGE, &["'3/2' is not a shard such as 3/20: K from 1 to N"]);
    desk.refused("sweep jobs.toml -o out --costs few", FAILS, &["--costs: goes with --shard"]);
    desk.refused("sweep jobs.toml -o out --shard 1/2 --costs few", FAILS, &["few: there are no times of shards"]);
    desk.refused("sweep jobs.toml -o out --shard 1/2 --report a.html", FAILS, &["--report: a page is of all shards"]);
    desk.refused("merge out", FAILS, &["out: there are no shards of a run (shards/command.json)"]);
    assert!(!desk.path("out").exists());
    desk.run("sweep jobs.toml -o out --shard 1/2");
    desk.refused("sweep jobs.toml -o out --shard 2/2 --costs out", FAILS, &["--costs: out is the folder that this run writes to"]);
    desk.write("other.toml", JOBS);
    desk.refused("sweep other.toml -o out --shard 2/2", FAILS, &["holds shards of `sweep jobs.toml`, and `sweep other.toml` does not mix"]);
    desk.run("cluster slurm --shards 2 -o engine -- sweep jobs.toml -o out");
    desk.refused("sweep jobs.toml -o engine --shard 1/2", FAILS, &["engine holds a run of `cluster`, and `sweep` does not mix with it"]);
    desk.refused("cluster slurm --shards 2 -o new -- info a.lod", FAILS, &["only the jobs of sweep"]);
    desk.refused("cluster slurm --shards 2 -o new -- sweep none.toml -o out", FAILS, &["cannot read none.toml"]);
    desk.refused(
        "cluster slurm --shards 2 -o new -- sweep jobs.toml",
        FAILS,
        &["`lodray sweep jobs.toml`: the following required arguments were not provided: --out <OUT>"],
    );
    desk.refused("cluster slurm --shards 2 -o new -- sweep jobs.toml -o out --shard 1/2", FAILS, &["--shard: the files name each shard"]);
    desk.refused(
        "cluster slurm --shards 2 -o new -- sweep jobs.toml -o out --threads 4",
        FAILS,
        &["--threads: a shard has as many as --cpus says"],
    );
    desk.refused("cluster snakemake --shards 2 --sbatch=-p=long -o new -- sweep jobs.toml -o out", FAILS, &["--sbatch: is for slurm"]);
    assert!(!desk.path("new").exists());
}

/// Stands for Slurm: tasks of an array two at a time, a task that asks for it again, a job that depends on others when all have ended.
const SBATCH: &str = r#"#!/bin/sh
for last; do :; done
array=$(sed -n 's/^#SBATCH --array=1-//p' "$last")
log=$(sed -n 's/^#SBATCH --output="\(.*\)"/\1/p' "$last")
task() {
  count=0
  while :; do
    rm -f "again-$1"
    SLURM_ARRAY_JOB_ID=7 SLURM_ARRAY_TASK_ID=$1 SLURM_RESTART_COUNT=$count sh "$last" >> "$(dirname "$log")/$1.log" 2>&1
    [ -e "again-$1" ] || return 0
    count=$((count + 1))
  done
}
if [ -n "$array" ]; then
  k=1
  while [ $k -le "$array" ]; do task $k & [ $((k % 2)) = 1 ] || wait; k=$((k + 1)); done
  wait
  echo "7;here"
else
  case $* in *--dependency=afterany:7\ *) ;; *) exit 9 ;; esac
  sh "$last" >> "$log" 2>&1
  echo 8
fi
"#;

/// A program that is killed once in each shard, after it has begun.
const FLAKY: &str = r#"#!/bin/sh
case $* in
  *--shard*) n=$(echo "$*" | sed 's/.*--shard//; s/[^0-9]/-/g'); if [ ! -e "killed$n" ]; then : > "killed$n"; kill -9 $$; fi ;;
esac
exec "$LODRAY" "$@"
"#;

#[test]
fn files_for_slurm_do_what_they_say() {
    use std::os::unix::fs::PermissionsExt;
    let desk = desk();
    // Names that a shell would take apart.
    desk.write("my jobs.toml", JOBS);
    let program = assert_cmd::cargo::cargo_bin!("lodray");
    for (name, text) in [("sbatch", SBATCH), ("flaky", FLAKY), ("scontrol", "#!/bin/sh\n: > \"again-${2#7_}\"\nfalse\n")] {
        desk.write(name, text);
        fs::set_permissions(desk.path(name), fs::Permissions::from_mode(0o755)).unwrap();
    }
    let lodray = |args: &[&str]| {
        let output = Command::new(program).args(args).current_dir(desk.folder()).env("LODRAY_CACHE", "none").output().unwrap();
        assert!(output.status.success() && output.stderr.is_empty(), "{args:?}: {output:?}");
        String::from_utf8(output.stdout).unwrap()
    };
    lodray(&["sweep", "my jobs.toml", "-o", "local"]);
    let said = lodray(&[
        "cluster",
        "slurm",
        "--shards",
        "5",
        "--program",
        "./flaky",
        "--sbatch=--partition=long",
        "-o",
        "my engine",
        "--",
        "sweep",
        "my jobs.toml",
        "-o",
        "my out",
    ]);
    assert!(said.starts_with("24 jobs in 5 shards, the longest 1.") && said.ends_with(" of the mean; sh 'my engine/submit'\n"), "{said}");
    let shard = desk.text("my engine/shard.sbatch");
    for line in
        ["#SBATCH --array=1-5", "#SBATCH --cpus-per-task=2", "#SBATCH --mem=4000M", "#SBATCH --time=240", "#SBATCH --partition=long"]
    {
        assert!(shard.lines().any(|of| of == line), "{line}: {shard}");
    }
    let path = format!("{}:{}", desk.folder().display(), std::env::var("PATH").unwrap());
    for _ in 0..2 {
        let mut submit = Command::new("sh");
        submit.arg("my engine/submit").current_dir(desk.folder());
        let output = submit.env("PATH", &path).env("LODRAY", program).env("LODRAY_CACHE", "none").output().unwrap();
        assert!(output.status.success() && output.stderr.is_empty(), "{output:?}");
        assert_eq!(String::from_utf8(output.stdout).unwrap(), "shards: job 7; merge: job 8; what they say: 'my engine/logs'\n");
        assert!(files(&desk, "my out") == files(&desk, "local"), "{}", desk.text("my engine/logs/merge.log"));
    }
    assert!(desk.text("my engine/logs/3.log").contains("shard 3/5 was killed (status 137), and is tried again"));
    each_once(&desk, "my out", 24);
}

#[test]
fn files_for_snakemake_have_a_job_for_each_shard() {
    let desk = desk();
    let said = desk.run("cluster snakemake --shards 3 --cpus 4 -o engine -- sweep jobs.toml -o {out}");
    assert!(said.ends_with("; snakemake -s engine/Snakefile --cores 4\n"), "{said}");
    let text = desk.text("engine/Snakefile");
    for line in [
        "    input: \"engine/done/merged-of-3\"",
        "    input: \"jobs.toml\"",
        "    output: touch(\"engine/done/{shard}-of-3\")",
        "    shell: \"lodray --quiet --threads {threads} sweep jobs.toml -o '{{out}}' --shard {wildcards.shard}/3\"",
        "    input: expand(\"engine/done/{shard}-of-3\", shard=range(1, 4))",
        "    shell: \"lodray --quiet merge '{{out}}'\"",
    ] {
        assert!(text.lines().any(|of| of == line), "{line}\n{text}");
    }
}

#[test]
fn shards_of_stability_give_the_bytes_of_one_run() {
    let desk = desk();
    desk.run("generate sphere --levels 2 --base 8 -o a.lod");
    let command = "stability a.lod --rays 3000 --hunt 200";
    desk.run(&format!("{command} -o local"));
    desk.refused(&format!("{command} --shard 1/3"), FAILS, &["--shard: needs a folder for the results (-o)"]);
    for k in 1..=3 {
        desk.run(&format!("{command} -o out --shard {k}/3 --threads {k}"));
    }
    desk.run("merge out");
    assert!(files(&desk, "out") == files(&desk, "local"));
}

#[test]
fn parts_of_the_lab_add_up() {
    use lodray::lab::hunt::{Hunt, climbs, hunt, hunt_climbs};
    use lodray::lab::suite::{Row, batches, shoot, shoot_batches};
    use lodray::lab::{CASES, Scale};
    // Through JSON, as between computers.
    fn again<T: serde::Serialize + serde::de::DeserializeOwned>(part: &T) -> T {
        serde_json::from_str(&serde_json::to_string(part).unwrap()).unwrap()
    }
    let case = CASES.iter().find(|case| case.name == "flat").unwrap();
    let (models, rays) = ((case.models)(Scale::Small).unwrap(), 9_000);
    let part = |range| again::<Row>(&shoot_batches(case, &models, rays, range, 3, &|_| ()));
    assert_eq!(batches(rays), 5);
    let parts = part(3..5).with(&part(0..1)).with(&part(1..3));
    assert_eq!(parts, shoot(case, &models, rays, 3, &|_| ()));
    let part = |range| again::<Hunt>(&hunt_climbs(None, 2_500, range, 3, &|_| ()).unwrap());
    assert_eq!(climbs(2_500), 3);
    assert_eq!(part(2..3).with(part(0..2)), hunt(None, 2_500, 3, &|_| ()).unwrap());
}
