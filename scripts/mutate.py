"""Breaks the RTL in small ways, one at a time, and shows that the tests notice each.

A mutant is one change of one operator, width, constant or condition in one file of rtl/. Sites are found by the rules below and drawn with a seed, so many a
file, from each rule by turns. Each mutant is a copy of rtl/ that the tests of the blocks that contain the file (or the unit's) run against, smallest block first, until one notices; with --unit against the unit's tests alone. A mutant that does not pass Verilator's lint says nothing about the tests:
it is counted apart and another one is drawn. Survivors must be listed with their reason in scripts/mutants.toml; any other makes the script fail.
"""

import argparse
import concurrent.futures
import json
import os
import pathlib
import random
import re
import shutil
import subprocess
import sys
import tomllib

ROOT = pathlib.Path(__file__).resolve().parent.parent
RTL = ROOT / "rtl"
REASONS = ROOT / "scripts" / "mutants.toml"

# Name, pattern, replacement. Patterns see code without comments; `<=` of assignments is told from the comparison by what stands before it.
RULES = [
    ("operator", r"(?<=[\w\])}]) \+ (?=[\w({~])", " - "),
    ("operator", r"(?<=[\w\])}]) - (?=[\w({~])", " + "),
    ("operator", r" && ", " || "),
    ("operator", r" \|\| ", " && "),
    ("operator", r" & ", " | "),
    ("operator", r" \| ", " & "),
    ("operator", r" << ", " >> "),
    ("operator", r" >>> ", " >> "),
    ("condition", r" == ", " != "),
    ("condition", r" != ", " == "),
    ("condition", r" < ", " <= "),
    ("condition", r" > ", " >= "),
    ("condition", r" >= ", " > "),
    ("condition", r"(?<=[(=&|?:] )!(?=\w)", ""),
    ("constant", r"(?<=\d'd)(\d+)\b", None),
    ("constant", r"1'b1\b", "1'b0"),
    ("constant", r"1'b0\b", "1'b1"),
    ("width", r"(?<=\[)(\d+)(?=:\d+\])", None),
]


def closure(module, sources):
    """The files that `module` is made of: itself and what it instantiates, all the way down."""
    seen, queue = set(), [module]
    while queue:
        name = queue.pop()
        if name in seen or name not in sources:
            continue
        seen.add(name)
        queue += [word for word in re.findall(r"^\s*(\w+)\s*(?:#\(|\w+\s*\()", sources[name], re.M) if word in sources]
    return seen


def sites(text):
    """(rule, start, end, replacement) of every place of `text` that a rule can change."""
    out = []
    offset = 0
    for line in text.splitlines(keepends=True):
        code = line.split("//")[0]
        skip = any(word in code for word in ("parameter", "localparam", "$error", "assert", "typedef", " for (")) or re.match(r"\s*(input|output|if \(.*(begin : g_))", code)
        if not skip:
            for rule, pattern, replacement in RULES:
                for m in re.finditer(pattern, code):
                    new = replacement
                    if new is None:
                        new = str(int(m.group(1)) + (1 if rule == "constant" else -1))
                        if rule == "width" and int(m.group(1)) == 0:
                            continue
                    out.append((rule, offset + m.start(), offset + m.end(), new))
        offset += len(line)
    return out


def by_turns(draw, sites, alike):
    """All sites in the order in which they are tried: those that are `alike` by turns, in an order and with sites that are drawn, so that a frequent operator does not push out a rare one."""
    by_kind = {}
    for site in sites:
        by_kind.setdefault(alike(site), []).append(site)
    groups = sorted(by_kind.items())
    draw.shuffle(groups)
    for _, group in groups:
        draw.shuffle(group)
    longest = max((len(group) for _, group in groups), default=0)
    return [group[k] for k in range(longest) for _, group in groups if k < len(group)]


def drawn(name, text, seed):
    """All sites of a module, in the order in which they are tried."""

    def alike(site):
        old = text[site[1] : site[2]].strip()
        return (site[0], "" if old.isdigit() else old)

    return by_turns(random.Random(f"{seed} {name}"), sites(text), alike)


def reason(mutant, reasons):
    """Why this mutant may live; None if nothing is known."""
    return next((r["why"] for r in reasons if r["file"] == mutant["file"] and r["after"] == mutant["after"]), None)


def known_reasons():
    return tomllib.loads(REASONS.read_text())["lives"]


def binaries(tests):
    """Paths of the compiled test binaries."""
    found = {}
    command = ["cargo", "test", "--no-run", "--message-format=json", "--quiet"] + [a for t in tests for a in ("--test", t)]
    run = subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, text=True)
    if run.returncode:
        sys.exit("mutate: the tests do not compile")
    for line in run.stdout.splitlines():
        message = json.loads(line)
        if message.get("reason") == "compiler-artifact" and message.get("executable") and message["target"]["name"] in tests:
            found[message["target"]["name"]] = message["executable"]
    return found


def describe(name, text, site):
    rule, start, end, new = site
    number = text.count("\n", 0, start) + 1
    begin = text.rfind("\n", 0, start) + 1
    stop = text.find("\n", start)
    before = text[begin:stop].strip()
    after = (text[begin:start] + new + text[end:stop]).strip()
    return {"file": name, "line": number, "rule": rule, "before": before, "after": after}


def verdict(index, name, text, site, command, limit):
    """Runs one mutant; gives "killed", "lint", "lives", or "late" if the tests did not end in time, which says nothing."""
    rtl = ROOT / "target" / "mutants" / f"{name}-{index}" / "rtl"
    shutil.rmtree(rtl.parent, ignore_errors=True)
    shutil.copytree(RTL, rtl)
    _, start, end, new = site
    (rtl / f"{name}.sv").write_text(text[:start] + new + text[end:])
    env = dict(os.environ, LODRAY_RTL=str(rtl), LODRAY_TRANSACTIONS="20000", LODRAY_CYCLES="200000", LODRAY_NIGHTLY="1", RUST_BACKTRACE="0")
    try:
        run = subprocess.run(command, cwd=ROOT, env=env, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=limit)
    except subprocess.TimeoutExpired:
        return "late"
    finally:
        shutil.rmtree(rtl.parent, ignore_errors=True)
    if " 0 passed; 0 failed" in run.stdout:
        sys.exit(f"mutate: no test ran for {name}.sv: {' '.join(command)}")
    if run.returncode == 0:
        return "lives"
    return "lint" if "%Warning" in run.stdout or "%Error" in run.stdout else "killed"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="*", help="modules to mutate (default: all)")
    parser.add_argument("--per-file", type=int, default=3, help="mutants a file (default 3)")
    parser.add_argument("--unit", action="store_true", help="against the tests of the whole unit alone, which every block in it must be noticed by (slow)")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--timeout", type=int, default=600, help="seconds a mutant")
    args = parser.parse_args()

    sources = {p.stem: p.read_text() for p in sorted(RTL.glob("*.sv")) if p.stem != "lod_pkg"}
    unknown = [f for f in args.files if f not in sources]
    if unknown:
        sys.exit(f"mutate: no such module in rtl/: {', '.join(unknown)}")
    tops = {p.stem for p in (ROOT / "tests" / "rtl").glob("*.rs")} & set(sources)
    tests = binaries(["rtl", "rtl_axi", "rtl_unit"])
    reasons = known_reasons()

    # The tests of a file are those of the tops that contain it; what only moves items has tests of its own, and so has what stands outside of the unit.
    own = {name: "queues" for name in ("arbiter", "hit_queue", "pipe_stage", "pipe_skid")}
    outside = {"axi_read_adapter": "adapter::", "traversal_unit_axi": "frame::"}
    cost = lambda top: sum(len(sources[m]) for m in closure(top, sources))
    unit = closure("traversal_unit", sources)
    # Few models first, all of them only where these notice nothing.
    of_unit = {of: [tests["rtl_unit"], *only] for of, only in (("rays", ["random_rays_under"]), ("unit", []))}
    plans = []
    for name in args.files or sources:
        holders = sorted((t for t in tops if name in closure(t, sources)), key=cost)
        tops_of = [own[name]] if name in own else holders
        commands = {top: [tests["rtl"], f"{top}::"] for top in tops_of} or of_unit
        if name in outside:
            commands = {"axi": [tests["rtl_axi"], outside[name]]}
        if args.unit:
            if name not in unit:
                continue
            commands = of_unit
        plans.append((name, drawn(name, sources[name], args.seed), commands))

    totals = {"killed": 0, "lint": 0, "lives": 0, "late": 0}
    unexplained = []

    def work(plan):
        name, order, commands = plan
        lines, tried = [], 0
        for index, site in enumerate(order):
            if tried == args.per_file:
                break
            for by, command in commands.items():
                outcome = verdict(index, name, sources[name], site, command, args.timeout)
                if outcome != "lives":
                    break
            what = describe(name, sources[name], site)
            tried += outcome in ("killed", "lives")
            lines.append((outcome, what, by))
        return lines

    with concurrent.futures.ThreadPoolExecutor(args.jobs) as pool:
        for lines in pool.map(work, plans):
            for outcome, what, by in lines:
                totals[outcome] += 1
                why = reason(what, reasons)
                if outcome == "lives" and why is None:
                    unexplained.append(what)
                if outcome != "lint":
                    note = f"  [{why}]" if outcome == "lives" and why else ""
                    print(f"{outcome:7} {what['file']}.sv:{what['line']} ({what['rule']}, {by}): {what['before']}  =>  {what['after']}{note}", flush=True)
    print(f"{totals['killed']} killed, {totals['lives']} live ({len(unexplained)} of them unexplained), {totals['lint']} more stopped by lint, {totals['late']} not done in time")
    if totals["killed"] == 0:
        sys.exit("mutate: nothing was killed")
    if unexplained:
        sys.exit("mutate: explain the survivors in scripts/mutants.toml, or strengthen the tests")


if __name__ == "__main__":
    main()
