"""Runs of the program whose documents are kept: what is there is not run again."""

import hashlib
import json
import subprocess


def kept(args, words):
    """The JSON document of a command, from `args.out` or made now by `args.program`."""
    words = [str(word) for word in words]
    name = "_".join(words).replace("/", "-").replace("--", "")
    # Names of files have at most 255 bytes.
    if len(name) > 200:
        name = name[:160] + "_" + hashlib.sha256(name.encode()).hexdigest()[:16]
    path = args.out / f"{name}.json"
    if not path.exists():
        run = subprocess.run([args.program, *words, "--json"], check=True, stdout=subprocess.PIPE, text=True)
        part = path.with_suffix(".part")
        part.write_text(run.stdout, encoding="utf-8")
        part.rename(path)
    return json.loads(path.read_text(encoding="utf-8"))


def knobs(point):
    """The options that choose the setting of a point of `error-time`. What all rays share is no choice of a method."""
    return [word for knob, value in point["knobs"].items() if knob != "packet" for word in (f"--{knob}", value)]
