"""Counts the registers of a top with slang: bits of the variables that are written at a clock edge, memories too, in every instance.

Usage: registers.py --top TOP [OPTION OF SLANG | FILE]...; prints the number of bits. `scripts/tools` installs slang.
"""

import sys

import pyslang


def written(expression):
    """The variables that an assignment's left side names."""
    kind = expression.kind.name
    if kind == "NamedValue":
        return [expression.symbol]
    if kind == "Concatenation":
        return [symbol for operand in expression.operands for symbol in written(operand)]
    if kind in ("ElementSelect", "RangeSelect", "MemberAccess"):
        return written(expression.value)
    raise SystemExit(f"registers.py: a left side of kind {kind}")


def main():
    driver = pyslang.Driver()
    driver.addStandardArgs()
    arguments = ["slang", "--single-unit", *(f'"{argument}"' for argument in sys.argv[1:])]
    if not (driver.parseCommandLine(" ".join(arguments)) and driver.processOptions() and driver.parseAllSources()):
        raise SystemExit(1)
    registers = {}

    def statement(node):
        if getattr(node.kind, "name", "") == "Assignment":
            registers.update((symbol.hierarchicalPath, symbol.type.bitstreamWidth) for symbol in written(node.left))

    def member(node):
        # The branch of a generate that was not taken.
        if node.kind.name == "GenerateBlock" and node.isUninstantiated:
            return pyslang.VisitAction.Skip
        if node.kind.name == "ProceduralBlock" and node.procedureKind.name == "AlwaysFF":
            node.body.visit(statement)
        return None

    for top in driver.createCompilation().getRoot().topInstances:
        top.visit(member)
    print(sum(registers.values()))


main()
