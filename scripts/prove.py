"""Proves the properties of rtl/formal/properties.toml about the RTL, and that each of them can fail.

A property is a module of rtl/formal around a block, or a fragment that is set inside one (`inside`), with immediate assert, assume and cover. Per property:
the asserts hold in every case that the assumptions leave; every cover is reached under them, so that they leave something; and each mutant, one small change
of the RTL, breaks an assert. Yosys writes each case as SMT-LIB, z3 decides it. Exit code 1 if anything fails, takes too long, or a mutant lives.

What is proved is written to rtl/formal/proved.txt, with a digest of all that the proof depends on, and is not proved again until that changes.
"""

import argparse
import concurrent.futures
import os
import sys
import time

from proving import document, ledger, properties
from proving.solve import Solver
from proving.tools import Failure, Tools


def main():
    """Runs what the command line asks for."""
    options = parse()
    try:
        every = properties.load()
        wanted = properties.chosen(every, options.name)
        if options.doc:
            document.write(every)
            return
        tools = Tools()
        solver = Solver(tools, options.keep)
        started = time.monotonic()
        proved = ledger.load()
        digests = {one.name: ledger.digest(one, solver) for one in wanted}
        # Who names a property wants to see it proved.
        again = options.all or options.name
        left = [one for one in wanted if again or proved.get(one.name) != digests[one.name]]
        results = run(solver, left, options.jobs)
        good = {result.property.name for result in results if not result.complaints}
        # What fails now is not proved, whatever was written before.
        kept = {name: digest for name, digest in proved.items() if name not in {one.name for one in left}}
        ledger.write(every, kept | {name: digests[name] for name in good})
    except Failure as why:
        sys.exit(f"scripts/prove: {why}")
    except KeyboardInterrupt:
        sys.exit("scripts/prove: stopped")
    if results:
        print(document.report(results))
    if len(left) < len(wanted):
        print(f"{len(wanted) - len(left)} properties were proved already, and nothing that they depend on has changed (--all proves them anew)")
    wrong = [line for result in results for line in result.complaints]
    wrong += [] if options.name else document.stale(every)
    for line in wrong:
        print(f"scripts/prove: {line}", file=sys.stderr)
    mutants = sum(len(result.mutants) for result in results)
    print(f"{len(results)} properties, {mutants} mutants, {len(wrong)} complaints, {time.monotonic() - started:.0f} s; {tools.versions}")
    sys.exit(1 if wrong else 0)


def run(solver, wanted, jobs):
    """The results in the order of `wanted`, whichever ends first: the longest are started first."""
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        order = sorted(wanted, key=lambda one: -one.seconds)
        started = {one.name: [pool.submit(case) for case in solver.cases(one)] for one in order}
        done = []
        try:
            for at, one in enumerate(wanted, 1):
                if sys.stderr.isatty():
                    print(f"\r\x1b[K{at} of {len(wanted)}: {one.name}", end="", file=sys.stderr, flush=True)
                done.append(properties.Result(one, [case.result() for case in started[one.name]]))
        except BaseException:
            pool.shutdown(cancel_futures=True)
            raise
        finally:
            if sys.stderr.isatty():
                print("\r\x1b[K", end="", file=sys.stderr, flush=True)
        return done


def parse():
    """The command line."""
    parser = argparse.ArgumentParser(prog="scripts/prove", description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("name", nargs="*", help="properties to prove (default: all)")
    parser.add_argument("--all", action="store_true", help="prove also what was proved and has not changed")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), metavar="N", help="tools at work at once (default: one per core)")
    parser.add_argument("--keep", action="store_true", help="keep the SMT-LIB files under target/prove")
    parser.add_argument("--doc", action="store_true", help="write the table of docs/formal.md from the properties and prove nothing")
    options = parser.parse_args()
    if options.jobs < 1:
        parser.error("--jobs must be at least 1")
    return options


if __name__ == "__main__":
    main()
