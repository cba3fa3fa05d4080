"""Options that several scripts have."""

import argparse
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def _program(text):
    path = Path(text).resolve()
    if not path.is_file():
        raise argparse.ArgumentTypeError(f"there is no program {text}")
    return path


def add_program(parser):
    """--program: lodray, which is there."""
    parser.add_argument("--program", type=_program, default=str(ROOT / "target" / "release" / "lodray"), help="lodray, built (default target/release/lodray)")


def ended(main):
    """Runs a script's main function. What a command refused, it has said itself."""
    try:
        main()
    except subprocess.CalledProcessError as error:
        sys.exit(error.returncode)
