"""Size, depth and clock of every block, in generic gates and on a Lattice ECP5.

Each step's result is kept under target/synth by the content that it depends on, so a run that was stopped goes on where it was, and only what changed is done
again. One block's failure names itself and leaves the others alone.
"""

import argparse
import concurrent.futures
import os
import sys

from synthesis import blocks, check, ecp5, fpga, gates, plan, report
from synthesis.tools import Failure, Tools


def main():
    """Runs what the command line asks for."""
    options = parse()
    try:
        tools = Tools()
        if options.fpga:
            fpga.run(options.fpga, options.link_registers, options.seeds, options.jobs, not options.no_route, options.paths, options.doc, tools)
            return
        unit = plan.read(options.plan) if options.plan else plan.of_machine(options.machine, options.set) if options.machine else None
        wanted = unit.blocks() if unit else blocks.chosen(options.block) or blocks.every()
        figures, failures = Run(tools, options).all(wanted)
        rows = [report.row(block.name, figures[block.name]) for block in wanted if block.name in figures]
        print(report.plain(rows))
        if unit and not failures:
            print(unit.sum(figures))
        if options.paths:
            print_paths(wanted, figures)
        if options.check and not failures:
            tested = [block for block in wanted if options.block or block.module in blocks.twins() or block.module in check.OTHERS]
            for block in tested:
                check.export(block, figures[block.name]["gates_at"])
            check.run(tested)
        if options.doc and not failures:
            if options.block == [blocks.WHOLE]:
                report.document(f"{report.BLOCKS} {blocks.WHOLE}", report.whole(figures[blocks.WHOLE]["gates"], blocks.contexts(), tools.versions))
            else:
                # The whole unit has a table of its own, and blocks in turns have.
                in_turns = {block.name for block in wanted if block.module in blocks.COPIES}
                placed = [row for row in rows if row[0] not in {blocks.WHOLE, *in_turns}]
                if placed:
                    report.document(report.BLOCKS, report.markdown(placed, tools.versions, bool(options.block)))
                if in_turns:
                    report.document(f"{report.BLOCKS} copies", report.copies([row for row in rows if row[0] in in_turns], tools.versions))
    except Failure as why:
        sys.exit(f"scripts/synth: {why}")
    except KeyboardInterrupt:
        sys.exit("scripts/synth: stopped; the next run goes on from here")
    for name, why in failures.items():
        print(f"scripts/synth: {name}: {why}", file=sys.stderr)
    sys.exit(1 if failures else 0)


def parse():
    """The command line."""
    parser = argparse.ArgumentParser(prog="scripts/synth", description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("block", nargs="*", help="module of rtl/ (tri_test-EDGES_PER_CYCLE=3 gives a parameter); all blocks if none is named")
    parser.add_argument("--seeds", type=int, default=3, metavar="N", help="place and route N times and take the median clock (default 3)")
    parser.add_argument("--no-place", action="store_true", help="leave place and route out")
    parser.add_argument("--no-fpga", action="store_true", help="leave the FPGA out: generic gates alone")
    parser.add_argument("--no-gates", action="store_true", help="leave the generic gates out")
    parser.add_argument("--paths", action="store_true", help="print the longest path of the slowest seed of each block")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), metavar="N", help="tools at work at once (default: one per core)")
    parser.add_argument("--check", action="store_true", help="write the netlists to target/synth/netlists and run the blocks' own tests on them")
    parser.add_argument("--plan", metavar="PLAN", help="the unit of a plan (lodray plan -o): its blocks with the package that the plan prints, and what they and its contexts have together")
    parser.add_argument("--machine", metavar="NAME|FILE", help="the unit of a machine (lodray unit): its blocks with the package that it prints, and what they and its contexts have together")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="with --machine: change a value of it, such as units.contexts=32; may be repeated")
    parser.add_argument("--fpga", type=int, nargs="?", const=2, metavar="CONTEXTS", help="the whole unit for an LFE5U-85F, with that many contexts (default 2): placed, routed, and as a bitstream")
    parser.add_argument("--link-registers", type=int, metavar="N", help="with --fpga: registers between contexts and blocks, 0 to 2 (default: as the hardware for an FPGA has them)")
    parser.add_argument("--no-route", action="store_true", help="with --fpga: place only, and tell the clock that the placer expects")
    parser.add_argument("--doc", action="store_true", help=f"write the table into docs/hardware.md, or the named blocks' rows of it; with {blocks.WHOLE} the parts of the whole unit, with --fpga its clock")
    options = parser.parse_args()
    if options.fpga is not None and not 1 <= options.fpga <= 64:
        parser.error(f"--fpga must be 1 to 64 contexts, but is {options.fpga}")
    if options.seeds < 1 or options.jobs < 1:
        parser.error("--seeds and --jobs must be at least 1")
    if options.no_fpga and options.no_gates:
        parser.error("--no-fpga and --no-gates leave nothing")
    of_whole = options.block == [blocks.WHOLE]
    if options.doc and not of_whole and (options.no_fpga or options.no_gates):
        parser.error("--doc writes whole rows of the table: leave nothing out but the clock (--no-place), which is a dash then")
    if options.doc and not of_whole:
        rows = {block.name for block in blocks.every()} - {blocks.WHOLE}
        others = [block.name for block in blocks.chosen(options.block) if block.name not in rows]
        if others:
            parser.error(f"--doc {others[0]}: the table of docs/hardware.md has no row of it; {blocks.WHOLE} goes by itself")
    if options.doc and of_whole and options.no_gates:
        parser.error(f"--doc {blocks.WHOLE} writes what the unit has in gates")
    if options.plan and options.machine:
        parser.error("--plan and --machine are two units")
    for name in ("plan", "machine"):
        if getattr(options, name) and (options.block or options.doc or options.check):
            parser.error(f"--{name} is of a whole unit: it has its own blocks, no place in docs/hardware.md, and its tests are those of cargo test")
    if options.set and not options.machine:
        parser.error("--set goes with --machine")
    if options.fpga is not None and (options.block or options.check or options.plan or options.machine or options.no_place or options.no_fpga):
        parser.error("--fpga is the whole unit: of all else it takes --seeds, --jobs, --link-registers, --no-route, --paths and --doc alone")
    if options.fpga is None and (options.link_registers is not None or options.no_route):
        parser.error("--link-registers and --no-route go with --fpga")
    if options.link_registers is not None and not 0 <= options.link_registers <= 2:
        parser.error(f"--link-registers must be 0 to 2, but is {options.link_registers}")
    if options.doc and (options.link_registers is not None or options.no_route):
        parser.error("--doc writes the clock of the unit as it is by default, routed: without --link-registers and --no-route")
    if options.check and options.no_gates:
        parser.error("--check needs the gates")
    return options


class Run:
    """The steps of all blocks on a pool of threads, each of which waits for one tool at a time."""

    def __init__(self, tools, options):
        self.tools, self.options = tools, options
        self.figures, self.failures, self.steps, self.done = {}, {}, {}, 0

    def all(self, wanted):
        """(figures by block, the failures' reasons by block)."""
        with concurrent.futures.ThreadPoolExecutor(self.options.jobs) as pool:
            for block in wanted:
                self.figures[block.name] = {}
                # What blocks in turns take is asked of gates alone.
                if not self.options.no_fpga and block.module not in blocks.COPIES:
                    self.start(pool, block, "ecp5", ecp5.synthesise)
                if not self.options.no_gates:
                    self.start(pool, block, "gates", gates.synthesise)
            try:
                while self.steps:
                    self.say()
                    for step in concurrent.futures.wait(self.steps, return_when=concurrent.futures.FIRST_COMPLETED).done:
                        self.finish(pool, step, *self.steps.pop(step))
            except KeyboardInterrupt:
                pool.shutdown(cancel_futures=True)
                raise
        self.say(end=True)
        return self.figures, self.failures

    def start(self, pool, block, kind, work, *arguments):
        """Queues a step."""
        self.steps[pool.submit(work, block, *arguments, self.tools)] = (block, kind)

    def finish(self, pool, step, block, kind):
        """Takes a step's result; placement follows the FPGA's synthesis."""
        self.done += 1
        figures = self.figures[block.name]
        try:
            result = step.result()
        except Failure as why:
            self.failures.setdefault(block.name, f"{kind}: {why}")
            return
        if kind == "place":
            figures["placed"] = sorted([*figures.get("placed", []), result[0]], key=lambda placed: placed["mhz"])
            figures["mhz"] = [placed["mhz"] for placed in figures["placed"]]
            return
        figures[kind], figures[f"{kind}_at"] = result
        # That has a hardware of its own for an FPGA, and --fpga.
        if kind == "ecp5" and not self.options.no_place and block.module != blocks.WHOLE:
            if not ecp5.fits(result[0]):
                figures["mhz"] = "does not fit"
                return
            for seed in range(1, self.options.seeds + 1):
                self.start(pool, block, "place", ecp5.place, result[1], seed)

    def say(self, end=False):
        """Progress, on a terminal only."""
        if sys.stderr.isatty():
            names = sorted({block.name for block, _ in self.steps.values()})
            line = "" if end else f"{self.done} of {self.done + len(self.steps)} steps, to do: {', '.join(names)}"
            print(f"\r\x1b[K{line[:150]}", end="", file=sys.stderr, flush=True)


def print_paths(wanted, figures):
    """The longest path of each block's slowest seed."""
    for block in wanted:
        for placed in figures[block.name].get("placed", [])[:1]:
            print(f"\n{block.name}: {placed['mhz']} MHz")
            for kind, delay, cell in placed["path"]:
                print(f"  {kind:8} {delay:6.2f} ns  {cell}")


if __name__ == "__main__":
    main()
