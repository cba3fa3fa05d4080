"""What the netlist of the whole unit goes through between synthesis and placement on an ECP5, for a shorter cycle and fewer wires."""

import inspect
import json

from . import absorb, copies
from .tools import write

# Functions of more inputs than a LUT has would be joined from up to eight of them, which the placer must keep in one place, with more wires.
OPTIONS = ("-nowidelut",)
# Cells that a LUT or register drives at most.
MOST_DRIVEN = 48


def ingredients():
    """All that a refined netlist depends on but for the netlist."""
    return [inspect.getsource(module) for module in (absorb, copies)] + [MOST_DRIVEN]


def refine(path, name):
    """Refines the module of this name in a netlist's file, and leaves out the others, which are the FPGA's cells; how many registers moved, and how many copies were made."""
    netlist = json.loads(path.read_text(encoding="utf-8"))
    module = netlist["modules"][name]
    counts = absorb.absorb(module), copies.copy_drivers(module, MOST_DRIVEN)
    write(path, json.dumps({**netlist, "modules": {name: module}}))
    return counts
