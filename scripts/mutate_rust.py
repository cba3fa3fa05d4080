"""Breaks the blocks (src/block) and the golden traverser (src/golden) in Rust in small ways, one at a time, and shows that the tests notice each.

A mutant is one change of one operator, condition, constant, method or function body. Sites are found and written by the tool in scripts/mutants, and drawn with a
seed: half of them of blocks, half of the golden traverser, each file and in it each rule by turns. One build of a copy of the tree holds all of them; the
environment variable LODRAY_MUTANT chooses one when a test runs. What does not compile is counted apart, and another one is drawn. Each mutant meets the tests that
ought to notice it, the nearest first, until one fails or takes far too long; one in a block that no test in Rust notices meets the tests of its RTL too, and is
said to be noticed by these alone. Survivors must be listed with their reason in scripts/mutants.toml; any other makes the script fail.
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
import subprocess
import sys
import threading
import time

from mutate import ROOT, by_turns, known_reasons, reason

TARGET = pathlib.Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")).absolute()
TREE = ROOT / "target" / "mutants" / "tree"
MEMORY = 8 << 30  # bytes of a test's address space: a loop that does not end may fill them

# What only accounts for area and energy.
ACCOUNTS = ("src/block/operation.rs", "src/block/parts/")

# Binaries and filters of their tests, in the order in which they are asked; {module} is the path of the mutated file's module.
LIB = "lodray"
STAGES = {
    "block": [(LIB, "{module}::"), (LIB, "block::"), ("equivalence", ""), ("box_test", ""), ("tri_test", ""), (LIB, "method::"), (LIB, "format::"), ("unit", ""), ("rtl", "{name}::")],
    "golden": [(LIB, "{module}::"), (LIB, "golden::"), ("golden", ""), ("bounds", ""), ("equivalence", ""), (LIB, "lab::"), ("watertight", ""), ("stability", "")],
}
TESTS = sorted({test for stages in STAGES.values() for test, _ in stages} - {LIB})

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
        if not (ROOT / file).is_file():
            continue
        content = ((stage if file in chosen else ROOT) / file).read_bytes()
        if file == "src/lib.rs":
            content = ALLOW.encode() + content + CHOICE.encode()
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


def build():
    """Paths of the test binaries, and the numbers of the mutants that do not compile."""
    command = ["cargo", "test", "--no-run", "--message-format=json", "--quiet", "--lib"] + [a for test in TESTS for a in ("--test", test)]
    run = subprocess.run(command, cwd=TREE, env=dict(os.environ, CARGO_TARGET_DIR=str(TARGET), CARGO_INCREMENTAL="0"), stdout=subprocess.PIPE, text=True)
    binaries, invalid, unexplained = {}, set(), []
    for message in map(json.loads, run.stdout.splitlines()):
        if message["reason"] == "compiler-artifact" and message["executable"]:
            binaries[message["target"]["name"]] = message["executable"]
        if message["reason"] == "compiler-message" and message["message"]["level"] == "error" and message["message"]["spans"]:
            numbers = blamed(message["message"])
            invalid |= numbers
            if not numbers:
                unexplained.append(message["message"]["rendered"])
    if run.returncode and not invalid:
        sys.exit("\n".join(["mutate: the copy of the tree does not compile", *unexplained]))
    return binaries, invalid


def ask(binary, filters, mutant, limit):
    """Runs tests with a mutant (0: none); gives "passed", "late", or the name of the test that failed."""
    # The same inputs in each run, and none that an earlier mutant left.
    env = dict(
        os.environ, LODRAY_MUTANT=str(mutant), RUST_BACKTRACE="0", PROPTEST_RNG_SEED="1", PROPTEST_DISABLE_FAILURE_PERSISTENCE="1", PROPTEST_MAX_SHRINK_ITERS="0", LODRAY_TRANSACTIONS="20000", LODRAY_CYCLES="200000"
    )
    memory = lambda: resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    run = subprocess.Popen([binary, filters], cwd=TREE, env=env, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, preexec_fn=memory, start_new_session=True)
    late = threading.Event()
    timer = threading.Timer(limit, lambda: (late.set(), run.kill()))
    timer.start()
    failed = None
    for line in run.stdout:
        if line.startswith("test ") and line.rstrip().endswith("FAILED"):
            failed = line.split()[1]
            run.kill()
    code = run.wait()
    timer.cancel()
    if late.is_set():
        return "late"
    return failed or ("passed" if code == 0 else "a crash")


class Tests:
    """The tests of the copy, each with the time that it takes without a mutant."""

    def __init__(self, binaries):
        self.binaries = binaries
        self.seconds = {}

    def stages(self, mutant):
        path = pathlib.Path(mutant["file"])
        module = "::".join(p for p in path.with_suffix("").parts[1:] if p != "mod")
        for test, filters in STAGES[path.parts[1]]:
            yield test, filters.format(module=module, name=path.stem)

    def limit(self, test, filters):
        if (test, filters) not in self.seconds:
            start = time.monotonic()
            outcome = ask(self.binaries[test], filters, 0, 3600)
            if outcome != "passed":
                sys.exit(f"mutate: {test} {filters} fails without a mutant: {outcome}")
            self.seconds[test, filters] = time.monotonic() - start
            print(f"        {test} {filters}: {self.seconds[test, filters]:.0f} s without a mutant", flush=True)
        return 30 + 4 * self.seconds[test, filters]

    def verdict(self, number, mutant):
        """The stage that noticed the mutant, and the test; None if none did."""
        for test, filters in self.stages(mutant):
            outcome = ask(self.binaries[test], filters, number, self.limit(test, filters))
            if outcome != "passed":
                return ("own" if filters.startswith(f"{pathlib.Path(mutant['file']).parts[1]}::") else test), outcome
        return None


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
        binaries, wrong = build()
        if not wrong:
            break
        print(f"        {len(wrong)} do not compile, others are drawn", flush=True)
        invalid += len(wrong)
        for number in sorted(wrong):
            del mutants[number]
            draw(group_of[number])

    tests, reasons = Tests(binaries), known_reasons()
    by_stage, unexplained, start = collections.Counter(), 0, time.monotonic()
    for number, mutant in mutants.items():
        noticed = tests.verdict(number, mutant)
        why = None if noticed else reason(mutant, reasons)
        stage = "lives" if not noticed else "late" if noticed[1] == "late" else noticed[0]
        by_stage[stage] += 1
        unexplained += not noticed and why is None
        note = f"  [{noticed[1]}]" if noticed else f"  [{why}]" if why else ""
        print(f"{stage:11} {number:3} {mutant['file']}:{mutant['line']} ({mutant['rule']}): {mutant['before']}  =>  {mutant['after']}{note}", flush=True)
    counts = ", ".join(f"{count} {stage}" for stage, count in by_stage.most_common())
    print(f"{len(mutants)} mutants: {counts} ({unexplained} of those that live unexplained); {invalid} more did not compile; {time.monotonic() - start:.0f} s of tests")
    if by_stage["lives"] == len(mutants):
        sys.exit("mutate: nothing was noticed")
    if unexplained:
        sys.exit("mutate: explain the survivors in scripts/mutants.toml, or strengthen the tests")


if __name__ == "__main__":
    main()
