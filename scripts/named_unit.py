"""The RTL of a hardware with a prefix before the names of its package and modules, so that units of two hardwares stand in one design: files and a list of them (files.f, for tools that take -F).

All sizes come from one package, which `lodray plan --package` prints for what a scene needs. In one design there is one of that name; so each further hardware has names of its own. Nothing else changes.
"""

import argparse
import os
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
RTL = ROOT / "rtl"


def parse():
    parser = argparse.ArgumentParser(prog="scripts/named-unit", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--package", type=Path, default=RTL / "lod_pkg.sv", metavar="FILE", help="the package of the hardware (lodray plan --package; default: rtl/lod_pkg.sv)")
    parser.add_argument("--prefix", required=True, metavar="NAME", help="what stands before every name, such as near_")
    parser.add_argument("-o", "--out", type=Path, required=True, metavar="FOLDER", help="where the files go")
    options = parser.parse_args()
    if not re.fullmatch(r"[A-Za-z_][A-Za-z0-9_]*", options.prefix):
        parser.error(f"--prefix {options.prefix}: a name in SystemVerilog begins with it, so letters, digits and _ alone, and no digit first")
    return options


def renamed(text, names, prefix):
    """The text with the prefix where a module or the package is declared or used; other words that are spelled alike stay."""
    name = "|".join(sorted(map(re.escape, names), key=len, reverse=True))
    declared = rf"(?<=^module )(?:{name})\b|(?<=^package )(?:{name})\b|(?<=^bind )(?:{name})\b"
    used = rf"\b(?:{name})(?=\s*#\()|\b(?:{name})(?=\s+u_\w+\s*\()|\blod_pkg(?=::)"
    return re.sub(f"{declared}|{used}", lambda found: prefix + found.group(), text, flags=re.MULTILINE)


def write(path, text):
    new = path.with_name(path.name + ".new")
    new.write_text(text, encoding="utf-8")
    os.replace(new, path)


def main():
    options = parse()
    files = [line for line in (RTL / "files.f").read_text(encoding="utf-8").splitlines() if line and not line.startswith("//")]
    names = [Path(file).stem for file in files]
    try:
        package = options.package.read_text(encoding="utf-8")
        if not re.search(r"^package lod_pkg;", package, re.MULTILINE):
            sys.exit(f"scripts/named-unit: {options.package}: no package lod_pkg in it")
        options.out.mkdir(parents=True, exist_ok=True)
        for file in files:
            text = package if file == "lod_pkg.sv" else (RTL / file).read_text(encoding="utf-8")
            write(options.out / (options.prefix + file), renamed(text, names, options.prefix))
        write(options.out / "files.f", "".join(f"{options.prefix}{file}\n" for file in files))
    except (OSError, UnicodeDecodeError) as error:
        sys.exit(f"scripts/named-unit: {error}")
    print(f"{len(files)} files in {options.out}; the unit is {options.prefix}traversal_unit, its sizes {options.prefix}lod_pkg")


if __name__ == "__main__":
    main()
