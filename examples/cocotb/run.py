"""One ray through the unit behind AXI, in Python: builds the RTL with cocotb's runner and runs `one_ray.py` on it.

    lodray generate sphere --levels 3 --base 32 -o sphere.lod
    lodray trace sphere.lod --pixel 24,24 --size 48x48 --distance 3 --ports ray.json
    python3 examples/cocotb/run.py sphere.lod ray.json

Needs cocotb (`pip install cocotb==2.1.0`), and Verilator 5.036 or newer with make, Perl and a C++ compiler.
"""

import argparse
import os
import sys
from pathlib import Path

from cocotb_tools.check_results import get_results
from cocotb_tools.runner import get_runner

HERE = Path(__file__).resolve().parent
RTL = HERE.parent.parent / "rtl"


def sources() -> list[Path]:
    """All of the RTL, and the rules of its ports: a broken one ends the simulation."""
    listed = [line for line in (RTL / "files.f").read_text().splitlines() if not line.startswith("//")]
    return [RTL / "lint.vlt", HERE / "ports.vlt", *(RTL / name for name in listed), *sorted((RTL / "rules").glob("*.sv"))]


def main() -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("scene", type=Path, help="scene file, which is the memory")
    parser.add_argument("ports", type=Path, help="ray and hit, from lodray trace --ports")
    parser.add_argument("--data-width", type=int, choices=[32, 64, 128, 256], default=64, help="bits of the bus (64)")
    parser.add_argument("--build", type=Path, default=Path("sim_build"), help="folder for the simulator (sim_build)")
    args = parser.parse_args()

    # One ray: the compiler would take longer to optimise than the model to run.
    os.environ.setdefault("MAKEFLAGS", "OPT_FAST=-O0 OPT_SLOW=-O0 CFG_CXXFLAGS_PCH_I=-include")
    runner = get_runner("verilator")
    runner.build(
        sources=sources(),
        hdl_toplevel="traversal_unit_axi",
        parameters={"CONTEXTS": 1, "DATA_W": args.data_width},
        build_args=["--assert", "--no-timing", "--no-public-flat-rw"],
        build_dir=args.build,
        timescale=("1ns", "1ps"),
    )
    results = runner.test(
        test_module="one_ray",
        hdl_toplevel="traversal_unit_axi",
        test_dir=HERE,
        results_xml=str(args.build.resolve() / "results.xml"),
        extra_env={"PYTHONPATH": str(HERE), "SCENE": str(args.scene.resolve()), "PORTS": str(args.ports.resolve())},
    )
    tests, failed = get_results(results)
    return 0 if tests == 1 and failed == 0 else 1


if __name__ == "__main__":
    sys.exit(main())
