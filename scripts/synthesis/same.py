"""That a refined netlist does in every cycle what it did before (refine.py), for a block that has all that refinement looks for."""

import json
import shutil

from . import absorb, refine
from .blocks import Block
from .tools import ROOT, YOSYS, Failure, Tools, kept

# Multipliers with registers on both sides.
BLOCK = Block("multiplier", (("FACTOR_STAGES", 1),))
# Its pipeline is five long.
CYCLES = 8
LIMIT_S = 1800
MODELS = "scripts/synthesis/ecp5_models.v"


def check(tools):
    """Proves it with a solver for all inputs of so many cycles from registers that are all zero, and counts the registers that moved; fails if the two differ, if none moved, or if the
    solver does not notice an enable that is gone."""

    def script(folder, refined="refined"):
        files = {"plain": "plain", "refined": refined}
        return [
            *(line for name, file in files.items() for line in (f"read_json {folder}/{file}.json", f"rename {BLOCK.module} {name}")),
            # Of the FPGA's cells LUTs and carries are as Yosys knows them.
            "read_verilog -overwrite +/lattice/cells_sim_ecp5.v", f"read_verilog -overwrite {MODELS}", "setattr -mod -unset lib_whitebox =A:lib_whitebox=1",
            "miter -equiv -make_outcmp plain refined both", "hierarchy -check -top both", "proc", "flatten", "async2sync", "setundef -undriven -zero", "opt -full",
            f"sat -verify -tempinduct-baseonly -maxsteps {CYCLES} -set-init-zero -prove trigger 0 both",
        ]

    def make(folder):
        synthesis = [*BLOCK.read(), "chformal -remove", f"synth_ecp5 -top {BLOCK.module} {' '.join(refine.OPTIONS)} -json {folder}/whole.json"]
        (ROOT / folder / "synthesis.ys").write_text("\n".join(synthesis) + "\n", encoding="utf-8")
        tools.run(YOSYS, ["-s", folder / "synthesis.ys"], folder / "synthesis.log", LIMIT_S)
        module = json.loads((ROOT / folder / "whole.json").read_text(encoding="utf-8"))["modules"][BLOCK.module]
        (ROOT / folder / "plain.json").write_text(json.dumps({"modules": {BLOCK.module: module}}), encoding="utf-8")
        shutil.copyfile(ROOT / folder / "plain.json", ROOT / folder / "refined.json")
        moved = refine.refine(ROOT / folder / "refined.json", BLOCK.module)
        if not moved:
            raise Failure(f"{BLOCK.name} is no test of refinement: no register moved")
        solve(folder, "refined")
        always_enabled(folder)
        try:
            solve(folder, "wrong")
        except Failure as why:
            if "proof did fail" in str(why):
                return {"moved": moved}
            raise
        raise Failure(f"{BLOCK.name}: a product's register that is always enabled is not noticed")

    def solve(folder, refined):
        (ROOT / folder / f"{refined}.ys").write_text("\n".join(script(folder, refined)) + "\n", encoding="utf-8")
        tools.run(YOSYS, ["-s", folder / f"{refined}.ys"], folder / f"{refined}.log", LIMIT_S)

    ingredients = {"block": BLOCK.ingredients(), "script": script("."), "models": (ROOT / MODELS).read_text(encoding="utf-8"), "refinement": refine.ingredients(), "tool": tools.versions[YOSYS]}
    made, _ = kept("same", ingredients, make)
    return made


def always_enabled(folder):
    """Writes the refined netlist with the enable of one product's register tied high."""
    netlist = json.loads((ROOT / folder / "refined.json").read_text(encoding="utf-8"))
    multipliers = (cell for cell in netlist["modules"][BLOCK.module]["cells"].values() if cell["type"] == absorb.MULTIPLIER)
    multiplier = next(cell for cell in multipliers if f"{absorb.PRODUCT}_CE" in cell["parameters"])
    multiplier["connections"][multiplier["parameters"][f"{absorb.PRODUCT}_CE"]] = ["1"]
    (ROOT / folder / "wrong.json").write_text(json.dumps(netlist), encoding="utf-8")


if __name__ == "__main__":
    print(f"{check(Tools())['moved']} registers moved")
