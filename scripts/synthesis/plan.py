"""The unit of a plan or of a machine: its package, its blocks, and its area."""

import hashlib
import json
import pathlib
import subprocess

from .blocks import Block
from .tools import OUT, ROOT, Failure, write


class Unit:
    """A unit, and for that of a plan the one that it leaves something out of."""

    def __init__(self, facts, package):
        self.own, self.full, self.package = facts["unit"], facts.get("full_unit"), package

    def blocks(self):
        """One of each."""
        return [Block(name, (), self.package) for name in self.own["blocks"]]

    def sum(self, figures):
        """Gate equivalents of the blocks and of the contexts, in words."""
        parts = sum(figures[name]["gates"]["ge"] for name in self.own["blocks"])
        contexts = round(self.own["contexts"] * self.own["context_gates"])
        full = f" The full unit has {self.full['contexts']} contexts of {self.full['context_bits']:,} bits." if self.full else ""
        return (
            f"One of each block has {parts:,} GE; {self.own['contexts']} contexts of {self.own['context_bits']:,} bits have {contexts:,}: "
            f"{parts + contexts:,} GE together.{full}"
        )


def read(path):
    """The unit of a plan's file."""
    path = pathlib.Path(path).resolve()
    if not path.is_file():
        raise Failure(f"{path} is missing")
    return printed(hashlib.sha256(path.read_bytes()).hexdigest(), "plan", "--plan", str(path))


def of_machine(name, changes):
    """The unit of a machine, changed."""
    file = pathlib.Path(name)
    name = str(file.resolve()) if file.is_file() else name
    words = ["--machine", name, *(f"--set={change}" for change in changes)]
    return printed(hashlib.sha256(" ".join(words).encode()).hexdigest(), "unit", *words)


def printed(digest, *words):
    """The unit that a command of the program prints."""
    package = OUT / "plans" / digest[:16] / "lod_pkg.sv"
    (ROOT / package).parent.mkdir(parents=True, exist_ok=True)
    command = ["cargo", "run", "--release", "--quiet", "--", *words, "--quiet", "--json", "--package", str(package)]
    got = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    if got.returncode != 0:
        raise Failure(f"lodray {words[0]}: {got.stderr.strip()}")
    write(ROOT / package.parent / "facts.json", got.stdout)
    return Unit(json.loads(got.stdout), str(package))
