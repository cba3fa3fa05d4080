"""The list of properties, rtl/formal/properties.toml, and what became of each."""

import dataclasses
import tomllib

from .tools import RTL, Failure

FORMAL = RTL / "formal"
LIST = FORMAL / "properties.toml"


@dataclasses.dataclass(frozen=True)
class Change:
    """One small change of a file of rtl/: `old`, which stands there once, becomes `new`."""

    file: str
    old: str
    new: str

    def apply(self, text):
        """The changed text."""
        if text.count(self.old) != 1:
            raise Failure(f"{self.file}.sv must contain {self.old!r} once, not {text.count(self.old)} times")
        return text.replace(self.old, self.new)


@dataclasses.dataclass(frozen=True)
class Fragment:
    """A file of rtl/formal that is set inside a module."""

    file: str
    inside: str


@dataclasses.dataclass(frozen=True)
class Property:
    """One property. `inside`: the module that the fragment is set into; without it the property is a module of its own."""

    name: str
    says: str
    block: str
    width: str
    file: str
    mutants: tuple
    module: str = ""  # the property's module, if not of its name
    inside: str = ""
    also: tuple = ()  # further fragments and the modules that they are set into
    registers: bool = False  # keep the elastic registers; else they are wires
    memory: bool = False  # has one: its state is a record with an array, else one long number
    apart: bool = False  # decide the asserts one by one
    induction: int = 0  # depth; 0: combinational
    reach: int = 8  # cycles in which covers and broken mutants must show
    stubs: tuple = ()  # modules of rtl/formal that take the place of those of rtl/
    helpers: tuple = ()  # modules of rtl/formal that the property is made with
    free: tuple = ()  # modules whose outputs become free variables
    cut: tuple = ()  # wires that become free variables
    parameters: tuple = ()
    narrow: tuple = ()  # changes that make a narrower version
    limit: int = 240  # seconds of one decision
    seconds: int = 1  # about how long it takes: the longest are started first

    @property
    def method(self):
        """How it is proved."""
        return f"induction, depth {self.induction}" if self.induction else "combinational"

    @property
    def fragments(self):
        """What is set inside modules."""
        return ((Fragment(self.file, self.inside),) if self.inside else ()) + self.also

    @property
    def top(self):
        """The module to prove."""
        return self.inside or self.module or self.name


def load():
    """Every property in the order of the list."""
    with LIST.open("rb") as file:
        table = tomllib.load(file)
    found = []
    for entry in table["property"]:
        changes = lambda key: tuple(Change(**change) for change in entry.pop(key, []))
        mutants, narrow = changes("mutant"), changes("narrow")
        if not mutants:
            raise Failure(f"{entry['name']} has no mutant that it rejects")
        lists = {key: tuple(entry.pop(key, [])) for key in ("stubs", "helpers", "free", "cut")}
        also = tuple(Fragment(**fragment) for fragment in entry.pop("also", []))
        parameters = tuple(sorted(entry.pop("parameters", {}).items()))
        found.append(Property(mutants=mutants, narrow=narrow, also=also, parameters=parameters, **lists, **entry))
    names = [one.name for one in found]
    if len(set(names)) != len(names):
        raise Failure("two properties have the same name")
    return found


def chosen(every, names):
    """The named ones, all without names."""
    unknown = sorted(set(names) - {one.name for one in every})
    if unknown:
        raise Failure(f"no such property: {', '.join(unknown)}; those of {LIST.relative_to(RTL.parent)} are known")
    return [one for one in every if not names or one.name in names]


@dataclasses.dataclass
class Verdict:
    """What one case came to: `wanted` is what it should have been, `trace` a counterexample in words."""

    kind: str  # proof, cover or mutant
    got: str
    wanted: str
    seconds: float
    trace: str = ""


class Result:
    """A property's verdicts."""

    def __init__(self, one, verdicts):
        self.property = one
        self.verdicts = verdicts
        self.proof = [verdict for verdict in verdicts if verdict.kind == "proof"]
        self.covers = [verdict for verdict in verdicts if verdict.kind == "cover"]
        self.mutants = [verdict for verdict in verdicts if verdict.kind == "mutant"]
        self.seconds = sum(verdict.seconds for verdict in verdicts)

    @property
    def complaints(self):
        """What is wrong with it, one line each and a counterexample where there is one."""
        lines = []
        for verdict in self.verdicts:
            if verdict.got != verdict.wanted:
                lines.append(f"{self.property.name}, {verdict.kind}: {verdict.got}, should be {verdict.wanted}{verdict.trace}")
        if not self.covers:
            lines.append(f"{self.property.name}: no cover shows that its assumptions can be met")
        return lines
