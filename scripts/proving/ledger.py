"""What is proved already: rtl/formal/proved.txt, a property a line with the digest of all that its verdicts depend on."""

import dataclasses
import hashlib
import os
import pathlib

from .properties import FORMAL

LEDGER = FORMAL / "proved.txt"
HEAD = "# scripts/prove: properties that were proved, and the digest of what each proof depends on\n"
# What a property says, how long it takes and how long it may take change no verdict.
OUTSIDE = ("says", "seconds", "limit")


def digest(one, solver):
    """The digest of the tools, the way they are asked, the property's entry, and the texts that it is made of."""
    entry = {field.name: getattr(one, field.name) for field in dataclasses.fields(one) if field.name not in OUTSIDE}
    made = hashlib.sha256()
    asked = pathlib.Path(__file__).with_name("solve.py").read_text(encoding="utf-8")
    for text in (solver.tools.versions, asked, repr(entry), *(text for pair in sorted(solver.texts(one).items()) for text in pair)):
        made.update(f"{len(text)}:{text}".encode())
    return made.hexdigest()[:32]


def load():
    """Digests by property, none where there is no such file."""
    if not LEDGER.is_file():
        return {}
    lines = LEDGER.read_text(encoding="utf-8").splitlines()
    return dict(line.split() for line in lines if line and not line.startswith("#"))


def write(every, digests):
    """Writes the digests of those properties that exist, in the order of their list."""
    lines = [f"{one.name} {digests[one.name]}\n" for one in every if one.name in digests]
    part = LEDGER.with_suffix(".part")
    part.write_text(HEAD + "".join(lines), encoding="utf-8")
    os.replace(part, LEDGER)
