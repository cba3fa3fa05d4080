"""The blocks' own tests, on their netlists instead of the RTL."""

import os
import re
import subprocess

from . import multipliers
from .gates import read_json
from .tools import OUT, ROOT, Failure, write

NETLISTS = OUT / "netlists"
TRANSACTIONS = 20_000


def export(block, folder):
    """Puts a block's netlist where the tests look for it. Its multipliers' gates have been checked apart; here they are plain products, which simulate faster."""
    text = (ROOT / folder / "netlist.v").read_text(encoding="utf-8")
    for name, module in read_json(folder / "multipliers.json")["modules"].items():
        if multipliers.is_multiplier(name):
            text, count = re.subn(rf"^module \\{re.escape(name)} .*?^endmodule\n", lambda _, name=name, module=module: multipliers.behavioural(name, module), text, flags=re.M | re.S)
            if count != 1:
                raise Failure(f"{block.name}: {count} modules {name} in the netlist, not one")
    write(ROOT / NETLISTS / f"{block.name}.v", text)


def run(names):
    """Runs the tests of these modules, and only those, on the netlists."""
    settings = {"LODRAY_NETLISTS": str(NETLISTS), "LODRAY_TRANSACTIONS": str(TRANSACTIONS)}
    for name in names:
        command = ["cargo", "test", "--test", "rtl", "--", f"{name}::"]
        print(" ".join([*(f"{key}={value}" for key, value in settings.items()), *command]), flush=True)
        got = subprocess.run(command, cwd=ROOT, env={**os.environ, **settings}, capture_output=True, text=True)
        passed = re.search(r"test result: ok\. (\d+) passed", got.stdout)
        if got.returncode != 0 or not passed or passed[1] == "0":
            raise Failure(f"{name}: its tests do not pass on its netlist:\n{got.stdout[-3000:]}{got.stderr[-2000:]}")
        print(f"{name}: {passed[1]} tests passed on the netlist")
