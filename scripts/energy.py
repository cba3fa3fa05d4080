#!/usr/bin/env python3
"""Adds up the energy of results again: from the counts in them, and from prices that it takes itself from the machine's tables.

scripts/energy.py RUN.json ...: results of `lodray simulate --json` (or files of a sweep's `results` with one result a line).
Caches and memory are priced from the tables that the machine names, below --machines (the project's own unless told), by their rows and by TN-41-01; operations of blocks and
the units by the result's prices, as what blocks are made of is the program's (docs/energy.md). Ends with 1 if any part is off by more than one in 10^9.
"""

import argparse
import csv
import json
import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
TOLERANCE = 1e-9


def row(machines, table, level, cache):
    """The row of a cache's geometry: read, write, leakage of a bank."""
    geometry = {key: cache[key] for key in ("bytes", "ways", "banks", "line_bytes")}
    for own in table.get(level, []):
        if own["geometry"] == geometry:
            return own["read"], own["fill"], own["leakage_mw_per_bank"]
    if "rows" in table:
        with open(machines / "energy" / table["rows"], newline="") as file:
            for line in csv.DictReader(file):
                if line["level"] == level and all(int(line[key]) == value for key, value in geometry.items()):
                    return float(line["read_pj"]), float(line["write_pj"]), float(line["leakage_mw_per_bank"])
    raise SystemExit(f"energy: {machines}: no row for the {level} of {geometry}")


def memory(device, counts):
    """Energies of the memory's parts in pJ, by Micron's TN-41-01."""
    t, io, devices = device["timing"], device["io"], device["organisation"]["devices_per_rank"]
    clock = device["clock_ps"] * 1e-3
    parts = dict.fromkeys(("background", "activate", "read", "write", "refresh"), 0.0)
    for supply in device["supply"]:
        pj = supply["volts"] * clock * devices
        mean_of_row = (supply["IDD3N"] * t["nRAS"] + supply["IDD2N"] * (t["nRC"] - t["nRAS"])) / t["nRC"]
        parts["background"] += pj * (
            supply["IDD3N"] * (counts["active_clocks"] - counts["active_down_clocks"])
            + supply["IDD3P"] * counts["active_down_clocks"]
            + supply["IDD2N"] * counts["precharged_clocks"]
            + supply["IDD2P"] * counts["precharged_down_clocks"]
        )
        parts["activate"] += pj * t["nRC"] * (supply["IDD0"] - mean_of_row) * counts["activates"]
        parts["read"] += pj * t["nBL"] * (supply["IDD4R"] - supply["IDD3N"]) * counts["reads"]
        parts["write"] += pj * t["nBL"] * (supply["IDD4W"] - supply["IDD3N"]) * counts["writes"]
        parts["refresh"] += pj * t["nRFC"] * (supply["IDD5B"] - supply["IDD3N"]) * counts["refreshes"]
    burst = t["nBL"] * clock * io["pins"] * devices
    parts["io"] = burst * (io["read_mw_per_pin"] * counts["reads"] + io["write_mw_per_pin"] * counts["writes"])
    return parts


def parts(result, machines):
    """Name, energy in the result, and the same again, part by part."""
    machine, energy = result["setup"]["machine"]["description"], result["energy"]
    prices = energy["prices"]
    table = tomllib.loads((machines / "energy" / f"{machine['energy']['caches']}.toml").read_text())
    scale = 1e-6 if energy["unit"] == "uJ" else 1.0
    nanoseconds = result["cycles"] / machine["cores"]["clock_mhz"] * 1e3
    sums = {}
    for level, copies in (("l1", machine["cores"]["groups"]), ("l2", 1)):
        read, fill, leakage = row(machines, table, level, machine[level])
        # Methods that write have more than requests and fills.
        reads = result[level]["requests"] + result[level].get("write_backs", 0)
        writes = result[level]["fills"] + result[level].get("updates", 0)
        yield f"{level}.read", energy[level]["read"], reads * read * scale
        yield f"{level}.fill", energy[level]["fill"], writes * fill * scale
        sums[level] = reads * read + writes * fill
        # A milliwatt is a picojoule in a nanosecond.
        sums[f"leakage.{level}"] = copies * machine[level]["banks"] * leakage * nanoseconds
        yield f"leakage.{level}", energy["leakage"][level], sums[f"leakage.{level}"] * scale
    if "dram_line" in table:
        of_memory = {"lines": table["dram_line"] * (result["dram"]["reads"] + result["dram"]["writes"])}
    else:
        of_memory = memory(tomllib.loads((machines / machine["dram"]["device"]).read_text()), result["dram"])
    if set(of_memory) != set(energy["dram"]["parts"]):
        raise SystemExit(f"energy: parts of the memory are {sorted(energy['dram']['parts'])}, not {sorted(of_memory)}")
    for name, value in of_memory.items():
        yield f"dram.{name}", energy["dram"]["parts"][name], value * scale
    sums["dram"] = sum(of_memory.values())
    priced = {name: result["operations"].get(name, 0) * price for name, price in prices["operations"].items()}
    if set(priced) != set(energy["compute"]["operations"]):
        raise SystemExit("energy: not all operations have a price and an energy")
    for name, value in priced.items():
        yield f"compute.{name}", energy["compute"]["operations"][name], value * scale
    clock = prices["units_clock"] * result["cycles"]
    yield "compute.clock", energy["compute"]["clock"], clock * scale
    sums["compute"] = sum(priced.values()) + clock
    sums["leakage.units"] = prices["units_leakage_mw"] * nanoseconds
    yield "leakage.units", energy["leakage"]["units"], sums["leakage.units"] * scale
    for name in ("l1", "l2", "dram", "compute"):
        yield name, energy[name]["total"], sums[name] * scale
    yield "total", energy["total"], sum(sums.values()) * scale


def results(path):
    """Results of a file: one, several, or one a line."""
    text = path.read_text()
    try:
        documents = [json.loads(text)]
    except json.JSONDecodeError:
        documents = [json.loads(line) for line in text.splitlines() if line.strip()]
    for document in documents if not isinstance(documents[0], list) else documents[0]:
        yield from (found for found in (document, document.get("result")) if found and "energy" in found)


def main():
    parser = argparse.ArgumentParser(description="Adds up the energy of results again.")
    parser.add_argument("files", nargs="+", type=Path, help="results of `lodray simulate --json`, or of a sweep, one a line")
    parser.add_argument("--machines", type=Path, default=ROOT / "machines", help="where the machines' tables lie")
    options = parser.parse_args()
    wrong = seen = 0
    for path in options.files:
        for result in results(path):
            seen += 1
            for name, given, again in parts(result, options.machines):
                if abs(given - again) > TOLERANCE * max(abs(given), abs(again)):
                    print(f"{path}: {name} is {given} {result['energy']['unit']}, but adds up to {again}", file=sys.stderr)
                    wrong += 1
    if seen == 0:
        sys.exit(f"energy: no result in {', '.join(map(str, options.files))}")
    print(f"{seen} results, every part again: {wrong} differ")
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
