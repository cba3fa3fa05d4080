"""Breaks the blocks (src/block) and the golden traverser (src/golden) in Rust in small ways, one at a time, and shows that the tests notice each.

A mutant is one change of one operator, condition, constant, method or function body. Sites are found and written by the tool in scripts/mutants, and drawn with a
seed: half of them of blocks, half of the golden traverser, each file and in it each rule by turns. One build of a copy of the tree holds all of them; the
environment variable LODRAY_MUTANT chooses one when a test runs. What does not compile is counted apart, and another one is drawn. Each mutant meets the tests that
ought to notice it, the nearest first, until one fails or takes more than five times as long as without it; one in a block that no test in Rust notices meets the tests of its RTL too, and is
said to be noticed by these alone. Survivors must be listed with their reason in scripts/mutants.toml, and then meet unit tests alone; any other makes the script fail.
"""

import argparse
import collections
import json
import os
import pathlib
import random
import re
import resource
import shutil
import signal
import subprocess
import sys
import time

from mutate import ROOT, by_turns, known_reasons, reason

TARGET = pathlib.Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")).absolute()
TREE = ROOT / "target" / "mutants" / "tree"
# Its own: cargo takes what is built from the copy for what is built from the tree itself, changed or not.
BUILD = ROOT / "target" / "mutants" / "build"
MEMORY = 8 << 30  # bytes of a test's address space: a loop that does not end may fill them

# What only accounts for area and energy.
ACCOUNTS = ("src/block/operation.rs", "src/block/parts/")

# Binaries and filters of their tests, in the order in which they are asked; {module} is the path of the mutated file's module.
LIB = "lodray"
STAGES = {
    "block": [(LIB, "{module}::"), (LIB, ""), ("hits", "box_test::"), ("hits", "tri_test::"), ("hits", "secondary::"), ("hits", "equivalence::"), ("hardware", "unit::"), ("rtl", "{name}::")],
    "golden": [(LIB, "{module}::"), (LIB, ""), ("hits", "golden::"), ("hits", "bounds::"), ("hits", "secondary::"), ("hits", "watertight::"), ("hits", "equivalence::")],
}

# Modules whose unit tests are built: blocks, golden traverser, what these use, and what their tests compare with. All others would take most of the time.
BUILT = ("num", "block", "mesh", "format", "golden")

# Not in the copy: cargo would build the program before each whole test.
PROGRAM = ("src/main.rs", "src/cli/")

# Put into the copy's lib.rs.
ALLOW = "#![allow(warnings, unconditional_panic, arithmetic_overflow)]\n"
CHOICE = """
pub mod mutant {
    static CHOSEN: std::sync::LazyLock<u32> = std::sync::LazyLock::new(|| std::env::var("LODRAY_MUTANT").map_or(0, |text| text.parse().expect("a number")));
    #[inline(always)]
    pub fn is(mutant: u32) -> bool {
        *CHOSEN == mutant
    }
}
"""


def tool(*arguments, text=None):
    """What the tool in scripts/mutants prints."""
    run = subprocess.run([TARGET / "debug" / "mutants", *arguments], cwd=ROOT, input=text, stdout=subprocess.PIPE, text=True)
    if run.returncode:
        sys.exit("mutate: the tool failed")
    return run.stdout


def files_of(group):
    return [str(p.relative_to(ROOT)) for p in sorted((ROOT / "src" / group).glob("**/*.rs")) if not str(p.relative_to(ROOT)).startswith(ACCOUNTS)]


def drawn(files, seed):
    """All sites of these files in the order in which they are tried, the files by turns."""
    by_file = {file: [] for file in files}
    for line in tool("list", *files).splitlines():
        site = json.loads(line)
        by_file[site["file"]].append(site)
    orders = [by_turns(random.Random(f"{seed} {file}"), sites, lambda site: (site["rule"], site["alike"])) for file, sites in by_file.items()]
    random.Random(seed).shuffle(orders)
    longest = max(map(len, orders))
    return [order[k] for k in range(longest) for order in orders if k < len(order)]


def put(path, content):
    """Writes what is new, so that nothing else is built again."""
    if not path.exists() or path.read_bytes() != content:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)


def grow(mutants):
    """The copy of the tree, with these mutants in it."""
    stage = TREE.parent / "stage"
    shutil.rmtree(stage, ignore_errors=True)
    chosen = collections.defaultdict(list)
    for number, mutant in mutants.items():
        chosen[mutant["file"]].append((mutant["site"], number))
    for file in chosen:
        put(stage / file, (ROOT / file).read_bytes())
    tool("write", stage, text=json.dumps(chosen))
    listed = subprocess.run(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"], cwd=ROOT, stdout=subprocess.PIPE, text=True, check=True).stdout
    for file in listed.rstrip("\0").split("\0"):
        if not (ROOT / file).is_file() or file.startswith(PROGRAM):
            continue
        content = ((stage if file in chosen else ROOT) / file).read_bytes()
        if file == "src/lib.rs":
            text = re.sub(r"^pub mod (?!(?:%s);)" % "|".join(BUILT), r"#[cfg(not(test))]\n\g<0>", content.decode(), flags=re.M)
            content = (ALLOW + text + CHOICE).encode()
        put(TREE / file, content)
    tools = TREE / "target" / "tools"
    if not tools.exists():
        tools.parent.mkdir(parents=True, exist_ok=True)
        tools.symlink_to((ROOT / "target" / "tools").resolve())


def blamed(message):
    """Numbers of the mutants that an error of the compiler speaks of, from the comments around them."""
    found = set()
    for span in sorted(message["spans"], key=lambda span: not span["is_primary"]):
        file = TREE / span["file_name"]
        if found or not file.is_file():
            continue
        open_ones = []
        for mark in re.finditer(rb"/\*([<>])(\d+)\*/", file.read_bytes()):
            if mark.start() > span["byte_start"]:
                break
            if mark[1] == b"<":
                open_ones.append(int(mark[2]))
            else:
                open_ones.pop()
        found.update(open_ones[-1:])
    return found


def build(test):
    """Path of a test binary, and the numbers of the mutants that do not compile."""
    command = ["cargo", "test", "--no-run", "--message-format=json", "--quiet"] + (["--lib"] if test == LIB else ["--test", test])
    run = subprocess.run(command, cwd=TREE, env=dict(os.environ, CARGO_TARGET_DIR=str(BUILD), CARGO_INCREMENTAL="0"), stdout=subprocess.PIPE, text=True)
    binary, invalid, unexplained = None, set(), []
    for message in map(json.loads, run.stdout.splitlines()):
        if message["reason"] == "compiler-artifact" and message["target"]["name"] == test and message["executable"]:
            binary = message["executable"]
        if message["reason"] == "compiler-message" and message["message"]["level"] == "error" and message["message"]["spans"]:
            numbers = blamed(message["message"])
            invalid |= numbers
            if not numbers:
                unexplained.append(message["message"]["rendered"])
    if run.returncode and not invalid:
        sys.exit("\n".join(["mutate: the copy of the tree does not compile", *unexplained]))
    return binary, invalid


def ask(binary, filters, mutant, limit):
    """Runs tests with a mutant (0: none) for at most so many seconds of the processor; gives the name of the test that failed, if one did, and seconds."""
    # The same inputs in each run, and none that an earlier mutant left.
    env = dict(
        os.environ, LODRAY_MUTANT=str(mutant), RUST_BACKTRACE="0", PROPTEST_RNG_SEED="1", PROPTEST_DISABLE_FAILURE_PERSISTENCE="1", PROPTEST_MAX_SHRINK_ITERS="0", LODRAY_TRANSACTIONS="20000", LODRAY_CYCLES="200000"
    )

    def limits():
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
        resource.setrlimit(resource.RLIMIT_CPU, (limit, limit))

    run = subprocess.Popen([binary, filters], cwd=TREE, env=env, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, preexec_fn=limits)
    failed = None
    for line in run.stdout:
        if line.startswith("test ") and line.rstrip().endswith("FAILED"):
            failed = line.split()[1]
            os.kill(run.pid, signal.SIGKILL)
    _, status, used = os.wait4(run.pid, 0)
    seconds = used.ru_utime + used.ru_stime
    if failed is None and status:
        failed = "late" if seconds >= limit else "a crash"
    return failed, seconds


class Tests:
    """The tests of the copy, built when they are first asked, each with the seconds that it takes without a mutant."""

    def __init__(self, binary):
        self.binaries = {LIB: binary}
        self.seconds = {}

    def limit(self, test, filters):
        if test not in self.binaries:
            self.binaries[test] = build(test)[0]
        if (test, filters) not in self.seconds:
            failed, seconds = ask(self.binaries[test], filters, 0, 3600)
            if failed:
                sys.exit(f"mutate: {test} {filters} fails without a mutant: {failed}")
            self.seconds[test, filters] = seconds
            print(f"        {test} {filters}: {seconds:.0f} s without a mutant", flush=True)
        return 20 + int(5 * self.seconds[test, filters])

    def noticed(self, number, mutant, test, filters):
        """The test that notices this mutant; None if all pass."""
        path = pathlib.Path(mutant["file"])
        module = "::".join(p for p in path.with_suffix("").parts[1:] if p != "mod")
        filters = filters.format(module=module, name=path.stem)
        limit = self.limit(test, filters)
        return ask(self.binaries[test], filters, number, limit)[0]


def main():
    parser = argparse.ArgumentParser(prog="scripts/mutate --rust", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="*", help="files of src/block and src/golden to mutate (default: all)")
    parser.add_argument("--count", type=int, default=60, help="mutants, half of them of blocks (default 60)")
    parser.add_argument("--seed", type=int, default=1)
    args = parser.parse_args()
    groups = {group: [file for file in files_of(group) if not args.files or file in args.files] for group in STAGES}
    unknown = set(args.files) - {file for files in groups.values() for file in files}
    if unknown:
        sys.exit(f"mutate: no file with mutants: {', '.join(sorted(unknown))}")
    if subprocess.run(["cargo", "build", "--quiet", "-p", "mutants"], cwd=ROOT, env=dict(os.environ, CARGO_TARGET_DIR=str(TARGET))).returncode:
        sys.exit("mutate: the tool does not compile")

    groups = [group for group in groups.values() if group]
    to_come = [iter(drawn(files, args.seed)) for files in groups]
    mutants, group_of = {}, {}

    def draw(group):
        site = next(to_come[group], None)
        if site:
            number = len(group_of) + 1
            mutants[number], group_of[number] = site, group

    for k in range(args.count):
        draw(k % len(groups))
    invalid = 0
    while True:
        grow(mutants)
        binary, wrong = build(LIB)
        if not wrong:
            break
        print(f"        {len(wrong)} do not compile, others are drawn", flush=True)
        invalid += len(wrong)
        for number in sorted(wrong):
            del mutants[number]
            draw(group_of[number])

    tests, reasons = Tests(binary), known_reasons()
    by_stage, start = collections.Counter(), time.monotonic()

    def tell(stage, number, note):
        mutant = mutants[number]
        by_stage[stage] += 1
        print(f"{stage:11} {number:3} {mutant['file']}:{mutant['line']} ({mutant['rule']}): {mutant['before']}  =>  {mutant['after']}  [{note}]", flush=True)

    # All mutants meet their nearest tests before any meets the next ones, which take longer.
    alive = list(mutants)
    for turn in range(max(map(len, STAGES.values()))):
        for number in list(alive):
            stages = STAGES[pathlib.Path(mutants[number]["file"]).parts[1]]
            if turn >= len(stages):
                continue
            test, filters = stages[turn]
            # What is known to live need not take the minutes of whole tests again.
            if test != LIB and reason(mutants[number], reasons):
                continue
            failed = tests.noticed(number, mutants[number], test, filters)
            if failed:
                by = "late" if failed == "late" else (filters if test == "hits" else test).removesuffix("::") if test != LIB else "own tests" if filters else "unit tests"
                tell(by, number, failed)
                alive.remove(number)
    unexplained = 0
    for number in alive:
        why = reason(mutants[number], reasons)
        unexplained += why is None
        tell("lives", number, why or "unexplained")
    counts = ", ".join(f"{count} {stage}" for stage, count in by_stage.most_common())
    print(f"{len(mutants)} mutants: {counts} ({unexplained} of those that live unexplained); {invalid} more did not compile; {time.monotonic() - start:.0f} s of tests")
    if by_stage["lives"] == len(mutants):
        sys.exit("mutate: nothing was noticed")
    if unexplained:
        sys.exit("mutate: explain the survivors in scripts/mutants.toml, or strengthen the tests")


if __name__ == "__main__":
    main()
