"""The whole traversal unit on a Lattice ECP5: as many contexts as asked for, placed and routed in the harness of the blocks, and written as a bitstream."""

import concurrent.futures
import os
import subprocess

from . import ecp5, refine, report, same
from .blocks import WHOLE, Block
from .tools import OUT, ROOT, Failure, Overtime

ECPPACK = "yowasp-ecppack"
TARGET_MHZ = 80
# For a netlist of this size the other router takes an hour.
PLACEMENT = ["--85k", "--package", "CABGA756", "--speed", "8", "--placer", "static", "--freq", TARGET_MHZ, "--timing-allow-fail", "--lpf-allow-unconstrained", "--router", "router2"]
# A netlist that the router can place all wires of takes it half an hour on a quiet machine, after ten minutes of placement; with others the wires that are used twice stay.
LIMIT_S = 7200


def unit(contexts, links):
    """The unit with the package of the hardware that is for this FPGA (Hardware::fpga in src/hardware), with so many registers on its links if a number is given, as cargo writes it."""
    package = OUT / "fpga" / "-".join([f"contexts-{contexts}", *([] if links is None else [f"links-{links}"])]) / "lod_pkg.sv"
    (ROOT / package).parent.mkdir(parents=True, exist_ok=True)
    settings = {"LODRAY_FPGA_PACKAGE": str(ROOT / package), "LODRAY_CONTEXTS": str(contexts), **({} if links is None else {"LODRAY_LINK_REGISTERS": str(links)})}
    got = subprocess.run(["cargo", "test", "--quiet", "--test", "hardware", "package::"], cwd=ROOT, env={**os.environ, **settings}, capture_output=True, text=True)
    if got.returncode != 0 or not (ROOT / package).is_file():
        raise Failure(f"cargo test --test hardware package:: {got.stdout[-2000:]}{got.stderr[-2000:]}")
    return Block(WHOLE, (), str(package))


def run(contexts, links, seeds, jobs, route, paths, doc, tools):
    """Synthesises the unit, places and routes it with each seed, and prints what came of it; with `doc` also into docs/hardware.md. Without `route` it is only placed, and the clock what the placer expects.

    A seed that the router finds no way for, or does not come to an end with in time, has no clock, and is slower than all others.
    """
    proved = same.check(tools)
    print(f"refinement changes nothing: {proved['moved']} registers moved into the multipliers of {same.BLOCK.name}, the same in {same.CYCLES} cycles of any inputs", flush=True)
    block = unit(contexts, links)
    size, netlist = ecp5.synthesise(block, tools, refine)
    print(f"traversal_unit of {contexts} contexts: {size['luts']:,} LUTs, {size['flip_flops']:,} flip-flops, {size['dsps']} multipliers, {size['memories']} block RAMs", flush=True)
    if not ecp5.fits(size):
        raise Failure(f"the FPGA has {ecp5.DSP_BLOCKS} multipliers")
    options = PLACEMENT if route else [*PLACEMENT, "--no-route"]
    placed, failures = [], []
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        steps = [pool.submit(ecp5.place, block, netlist, seed, tools, options, LIMIT_S, configuration=route) for seed in range(1, seeds + 1)]
        for seed, step in enumerate(steps, start=1):
            try:
                made, folder = step.result()
            except Failure as why:
                if isinstance(why, Overtime) or "Failed to route" in str(why):
                    placed.append({"mhz": 0.0, "path": []})
                    print(f"seed {seed}: not routed ({why})", flush=True)
                else:
                    failures.append(f"seed {seed}: {why}")
                continue
            placed.append(made)
            print(f"seed {seed}: {made['mhz']} MHz, {f'bitstream {pack(folder, tools)}' if route else 'not routed'}", flush=True)
    if failures:
        raise Failure("; ".join(failures))
    print(f"median in MHz: {report.clock(report.median([made['mhz'] for made in placed]))}")
    if paths:
        for kind, delay, cell in min((made for made in placed if made["path"]), key=lambda made: made["mhz"], default={"path": []})["path"]:
            print(f"  {kind:8} {delay:6.2f} ns  {cell}")
    if doc:
        report.document("scripts/synth --fpga", report.fpga(contexts, size, placed, PLACEMENT, tools.versions))


def pack(folder, tools):
    """The bitstream of a placed and routed unit, and its size."""
    bits = folder / "unit.bit"
    if not (ROOT / bits).is_file():
        got = subprocess.run([tools.folder / ECPPACK, folder / "unit.config", bits], cwd=ROOT, capture_output=True, text=True)
        if got.returncode != 0:
            raise Failure(f"{ECPPACK}: {' '.join(got.stderr.split())[-500:]}")
    return f"{bits} ({(ROOT / bits).stat().st_size:,} bytes)"
