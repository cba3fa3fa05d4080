"""What the netlist of the whole unit goes through between synthesis and placement on an ECP5, for a shorter cycle and fewer wires."""

import inspect
import json
import sys

from . import absorb
from .tools import write

# Functions of more inputs than a LUT has would be joined from up to eight of them, which the placer must keep in one place, with more wires.
OPTIONS = ("-nowidelut",)


def ingredients():
    """All that a refined netlist depends on but for the netlist."""
    return [inspect.getsource(module) for module in (absorb, sys.modules[__name__])]


def refine(path, name):
    """Refines the module of this name in a netlist's file; how many registers moved into multipliers."""
    netlist = json.loads(path.read_text(encoding="utf-8"))
    moved = absorb.absorb(netlist["modules"][name])
    write(path, json.dumps(netlist))
    return moved
