"""What the netlist of the whole unit goes through between synthesis and placement on an ECP5, for a shorter cycle and fewer wires."""

import inspect
import json

from . import absorb
from .tools import write

# Functions of more inputs than a LUT has would be joined from up to eight of them, which the placer must keep in one place, with more wires.
OPTIONS = ("-nowidelut",)


def ingredients():
    """All that a refined netlist depends on but for the netlist."""
    return inspect.getsource(absorb)


def refine(path, name):
    """Refines the module of this name in a netlist's file, and leaves out the others, which are the FPGA's cells; how many registers moved into multipliers."""
    netlist = json.loads(path.read_text(encoding="utf-8"))
    module = netlist["modules"][name]
    moved = absorb.absorb(module)
    write(path, json.dumps({**netlist, "modules": {name: module}}))
    return moved
