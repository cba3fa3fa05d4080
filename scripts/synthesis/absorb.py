"""Registers before and after the multipliers of an ECP5 netlist, moved into them.

Yosys maps a product to the multiplier alone, and leaves the registers around it to the fabric. A multiplier of the FPGA has registers of its own for each factor and
for the product, so those of a product need no slice, no wire between slice and multiplier, and less of a cycle.
"""

import collections

MULTIPLIER = "MULT18X18D"
REGISTER = "TRELLIS_FF"
FACTORS = {"A": "REG_INPUTA", "B": "REG_INPUTB"}
PRODUCT = "REG_OUTPUT"
FACTOR_BITS, PRODUCT_BITS = 18, 36


def absorb(module):
    """Moves registers of a netlist's module (as Yosys writes it in JSON) into its multipliers; how many registers went.

    A factor's or a product's registers move if all have one clock, one enable and no reset, and all that a factor's drive, or all that a bit of the product drives,
    are multipliers or registers that move: so nothing else sees the difference, and every bit is in every cycle what it was. (Before the first clock edge with the enable the
    value of such a register is unknown in the fabric as in the multiplier.)
    """
    cells = module["cells"]
    drivers, sinks = wiring(cells)
    # Module outputs are seen from outside.
    outside = {bit for port in module["ports"].values() if port["direction"] == "output" for bit in port["bits"]}
    multipliers = {name: cell for name, cell in cells.items() if cell["type"] == MULTIPLIER}

    moved = {}  # (multiplier, parameter) -> its registers, by port
    behind = set()
    for name, cell in multipliers.items():
        after = {}
        for port, bit in bits(cell, "P", PRODUCT_BITS):
            if sinks[bit] or bit in outside:
                after[port] = sinks[bit][0][0] if len(sinks[bit]) == 1 and sinks[bit][0][1] == "DI" and bit not in outside else None
        if after and all(after.values()) and control(cells, after.values()):
            moved[name, PRODUCT] = after
            behind |= set(after.values())
    for name, cell in multipliers.items():
        for factor, parameter in FACTORS.items():
            before = {port: register_of(cells, drivers.get(bit)) for port, bit in bits(cell, factor, FACTOR_BITS)}
            # A register between two multipliers goes into the first.
            if before and all(before.values()) and control(cells, before.values()) and behind.isdisjoint(before.values()):
                moved[name, parameter] = before

    # A register that something else reads too would stay, and its multiplier would take its input from further away.
    while True:
        takers = collections.defaultdict(set)
        for (name, parameter), registers in moved.items():
            for port, register in registers.items():
                takers[register].add((name, port))
        kept = {}
        for key, registers in moved.items():
            outputs = {register: cells[register]["connections"]["Q"][0] for register in registers.values()}
            if key[1] == PRODUCT or all(bit not in outside and set(sinks[bit]) == takers[register] for register, bit in outputs.items()):
                kept[key] = registers
        if len(kept) == len(moved):
            break
        moved = kept

    before = sum(cell["type"] == REGISTER for cell in cells.values())
    gone = set()
    for (name, parameter), registers in moved.items():
        cell = cells[name]
        clock, enable = control(cells, registers.values())
        link(cell, parameter, clock, enable)
        for port, register in registers.items():
            cell["connections"][port] = list(cells[register]["connections"]["Q" if parameter == PRODUCT else "DI"])
        gone |= set(registers.values())
    for register in gone:
        del cells[register]
    return before - sum(cell["type"] == REGISTER for cell in cells.values())


def wiring(cells):
    """Which cell drives a bit, and which ports it goes to."""
    drivers, sinks = {}, collections.defaultdict(list)
    for name, cell in cells.items():
        for port, connected in cell["connections"].items():
            for bit in connected:
                if isinstance(bit, int):
                    if cell["port_directions"][port] == "output":
                        drivers[bit] = name
                    else:
                        sinks[bit].append((name, port))
    return drivers, sinks


def bits(cell, letter, count):
    """The ports of a factor or product that are no constants, and their bits."""
    named = ((f"{letter}{at}", cell["connections"].get(f"{letter}{at}", [])) for at in range(count))
    return [(port, connected[0]) for port, connected in named if connected and isinstance(connected[0], int)]


def register_of(cells, driver):
    """The driver, if it is a register."""
    return driver if driver and cells[driver]["type"] == REGISTER else None


def control(cells, registers):
    """Clock and enable (None: every cycle) that all these registers have, if a multiplier's can be the same; otherwise None."""
    found = set()
    for register in registers:
        if cells[register]["type"] != REGISTER:
            return None
        parameters = {name: value.strip() for name, value in cells[register]["parameters"].items()}
        connections = cells[register]["connections"]
        if parameters["CLKMUX"] != "CLK" or connections["LSR"] != ["0"] or parameters["LSRMUX"] != "LSR" or parameters["CEMUX"] not in ("CE", "1"):
            return None
        found.add((connections["CLK"][0], connections["CE"][0] if parameters["CEMUX"] == "CE" else None))
    return found.pop() if len(found) == 1 else None


def link(cell, parameter, clock, enable):
    """Gives a multiplier's register its clock and enable: clock 0, and an enable of its own."""
    number = list([*FACTORS.values(), PRODUCT]).index(parameter)
    cell["parameters"] |= {f"{parameter}_CLK": "CLK0", f"{parameter}_CE": f"CE{number}", f"{parameter}_RST": "RST0", "GSR": "DISABLED"}
    for port, bit in (("CLK0", clock), (f"CE{number}", "1" if enable is None else enable), ("RST0", "0")):
        cell["connections"][port] = [bit]
        cell["port_directions"][port] = "input"
