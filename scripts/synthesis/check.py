"""The blocks' own tests, on their netlists instead of the RTL."""

import os
import re
import subprocess

from . import multipliers
from .blocks import WHOLE
from .gates import read_json
from .tools import OUT, ROOT, Failure, write

NETLISTS = OUT / "netlists"
TRANSACTIONS = 20_000
# Not tests of the module's name in tests/rtl, but a test of another suite.
OTHERS = {WHOLE: ("rtl_unit", "a_frame_of_a_sphere")}


def export(block, folder):
    """Puts a block's netlist where the tests look for it. Its multipliers' gates have been checked apart; here they are plain products, which simulate faster."""
    text = (ROOT / folder / "netlist.v").read_text(encoding="utf-8")
    for name, module in read_json(folder / "multipliers.json")["modules"].items():
        if multipliers.is_multiplier(name):
            text, count = re.subn(rf"^module \\{re.escape(name)} .*?^endmodule\n", lambda _, name=name, module=module: multipliers.behavioural(name, module), text, flags=re.M | re.S)
            if count != 1:
                raise Failure(f"{block.name}: {count} modules {name} in the netlist, not one")
    write(ROOT / NETLISTS / f"{block.name}.v", text)


def run(blocks):
    """Runs the blocks' tests, and only those, on the netlists; of the whole unit the frame that it renders."""
    modules = sorted({block.module for block in blocks})
    untested = [module for module in modules if module not in OTHERS and not (ROOT / "tests/rtl" / f"{module}.rs").is_file()]
    if untested:
        raise Failure(f"no tests in tests/rtl for {', '.join(untested)}")
    suites = [("rtl", [f"{module}::" for module in modules if module not in OTHERS])]
    suites += [(suite, [test]) for module, (suite, test) in OTHERS.items() if module in modules]
    for suite, tests in suites:
        if tests:
            play(suite, tests)


def play(suite, tests):
    """Runs these tests of a suite on the netlists, and sees to it that each of them was there."""
    settings = {"LODRAY_NETLISTS": str(NETLISTS), "LODRAY_TRANSACTIONS": str(TRANSACTIONS)}
    command = ["cargo", "test", "--test", suite, "--", *tests]
    print(" ".join([*(f"{name}={value}" for name, value in settings.items()), *command]), flush=True)
    got = subprocess.run(command, cwd=ROOT, env={**os.environ, **settings}, capture_output=True, text=True)
    passed = re.findall(r"^test (\S+) \.\.\. ok$", got.stdout, re.MULTILINE)
    missing = [test for test in tests if not any(name.startswith(test) for name in passed)]
    if got.returncode != 0 or missing:
        raise Failure(f"{', '.join(missing) or 'some test'} of tests/{suite} does not pass on the netlists:\n{got.stdout[-4000:]}{got.stderr[-2000:]}")
    of_blocks = f", {TRANSACTIONS:,} transactions free-running and as many stalled each" if suite == "rtl" else ""
    print(f"{len(passed)} tests of {', '.join(test.rstrip(':') for test in tests)} passed on the netlists{of_blocks}")
