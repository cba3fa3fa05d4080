"""The unit of a plan: its package, its blocks, and its area."""

import hashlib
import json
import pathlib
import subprocess

from .blocks import Block
from .tools import OUT, ROOT, Failure, write


class Unit:
    """The unit that `lodray plan` has for a plan, and the one that it leaves something out of."""

    def __init__(self, facts, package):
        self.own, self.full, self.package = facts["unit"], facts["full_unit"], package

    def blocks(self):
        """One of each."""
        return [Block(name, (), self.package) for name in self.own["blocks"]]

    def sum(self, figures):
        """Gate equivalents of the blocks and of the contexts, in words."""
        parts = sum(figures[name]["gates"]["ge"] for name in self.own["blocks"])
        contexts = round(self.own["contexts"] * self.own["context_gates"])
        return (
            f"One of each block has {parts:,} GE; {self.own['contexts']} contexts of {self.own['context_bits']:,} bits have {contexts:,}: "
            f"{parts + contexts:,} GE together. The full unit has {self.full['contexts']} contexts of {self.full['context_bits']:,} bits."
        )


def read(path):
    """The unit of a plan's file."""
    path = pathlib.Path(path).resolve()
    if not path.is_file():
        raise Failure(f"{path} is missing")
    package = OUT / "plans" / f"{hashlib.sha256(path.read_bytes()).hexdigest()[:16]}" / "lod_pkg.sv"
    (ROOT / package).parent.mkdir(parents=True, exist_ok=True)
    command = ["cargo", "run", "--release", "--quiet", "--", "plan", "--quiet", "--plan", str(path), "--json", "--package", str(package)]
    got = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    if got.returncode != 0:
        raise Failure(f"lodray plan: {got.stderr.strip()}")
    write(ROOT / package.parent / "facts.json", got.stdout)
    return Unit(json.loads(got.stdout), str(package))
