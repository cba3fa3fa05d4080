"""Options that several scripts have."""

import argparse
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
