"""Copies of what drives many cells of an ECP5 netlist, so that each copy can lie near those that it drives.

The placer leaves every driver in one place, and the wire from there to the furthest of a thousand cells is longer than a cycle. A copy has the same inputs, and so in every
cycle the same value. Who takes which is told by the names of the nets that they drive: neighbouring bits of a word are placed together.
"""

import copy
import re

from .absorb import REGISTER, wiring

LUT = "LUT4"
OUTPUT = {LUT: "Z", REGISTER: "Q"}
CLOCKS = ("CLK", "WCK", "CLK0")
NUMBER = re.compile(r"\d+")


def copy_drivers(module, most):
    """Copies LUTs and registers of a netlist's module (as Yosys writes it in JSON) that drive more than `most` inputs of cells, until none does; how many copies were made."""
    cells = module["cells"]
    drivers, sinks = wiring(cells)
    outside = {bit for port in module["ports"].values() if port["direction"] == "output" for bit in port["bits"]}
    names = named(module["netnames"])
    free = 1 + max(bit for net in module["netnames"].values() for bit in net["bits"] if isinstance(bit, int))

    def place(sink):
        cell, port = sink
        output = OUTPUT.get(cells[cell]["type"])
        return (*names.get(cells[cell]["connections"][output][0] if output else None, ((cell,), 0)), cell, port)

    made = 0
    # From the ends of the paths backwards: copies are more inputs for what drives them. Registers, which end paths, come last.
    for bit in sorted(drivers, key=levels(cells, drivers), reverse=True):
        driver = drivers[bit]
        taken = set(sinks[bit])
        if cells[driver]["type"] not in OUTPUT or bit in outside or len(taken) <= most or any(port in CLOCKS for _, port in taken):
            continue
        ordered = sorted(taken, key=place)
        parts = -(-len(ordered) // most)
        each = -(-len(ordered) // parts)
        for number in range(1, -(-len(ordered) // each)):
            twin = f"{driver}$copy{number}"
            cells[twin] = copy.deepcopy(cells[driver])
            cells[twin]["connections"][OUTPUT[cells[driver]["type"]]] = [free]
            drivers[free] = twin
            sinks[free] = ordered[number * each : (number + 1) * each]
            for cell, port in sinks[free]:
                connections = cells[cell]["connections"]
                connections[port] = [free if other == bit else other for other in connections[port]]
            for port, connected in cells[twin]["connections"].items():
                if cells[twin]["port_directions"][port] == "input":
                    for other in connected:
                        sinks[other].append((twin, port))
            free += 1
            made += 1
        sinks[bit] = ordered[:each]
    return made


def named(nets):
    """The shortest name of each bit and its place there; numbers in names count as numbers."""
    found = {}
    for name, net in nets.items():
        for at, bit in enumerate(net["bits"]):
            if bit not in found or (len(name), name) < found[bit][0]:
                found[bit] = (len(name), name), at
    return {bit: (tuple(NUMBER.sub(lambda digits: digits[0].zfill(6), name).split(".")), at) for bit, ((_, name), at) in found.items()}


def levels(cells, drivers):
    """A function from a bit to the LUTs and carries on the longest way to it from a register."""
    known = {}

    def own(bit):
        driver = drivers.get(bit)
        if driver is None or cells[driver]["type"] not in (LUT, "CCU2C", "PFUMX", "L6MUX21"):
            return None
        cell = cells[driver]
        return [other for port, connected in cell["connections"].items() if cell["port_directions"][port] == "input" for other in connected if isinstance(other, int)]

    def of(bit):
        # Not by recursion: a chain of carries is longer than Python's stack.
        waiting = [bit]
        while waiting:
            top = waiting[-1]
            inputs = own(top) if top not in known else None
            if inputs is None:
                known.setdefault(top, 0)
                waiting.pop()
                continue
            missing = [other for other in inputs if other not in known]
            if missing:
                waiting += missing
            else:
                known[top] = 1 + max((known[other] for other in inputs), default=0)
                waiting.pop()
        return known[bit]

    return of
