"""Elaborates SystemVerilog with slang, which takes the standard by its word: names before their use, no net that nobody declared.

Usage: elaborate.py [OPTION OF SLANG | FILE]...; exits with 1 and slang's words if there is an error or a warning. `scripts/tools` installs it.
"""

import sys

import pyslang

driver = pyslang.Driver()
driver.addStandardArgs()
arguments = ["slang", "--single-unit", "-Werror", *(f'"{argument}"' for argument in sys.argv[1:])]
right = driver.parseCommandLine(" ".join(arguments)) and driver.processOptions() and driver.parseAllSources()
sys.exit(0 if right and driver.runFullCompilation(True) else 1)
