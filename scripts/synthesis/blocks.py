"""The blocks: which there are, with which parameters, and the files that each is made of."""

import dataclasses
import re

from .tools import ROOT, Failure

RTL = ROOT / "rtl"
PACKAGE = "lod_pkg"

# Blocks are the modules with a twin in src/block; of these, some come in several forms.
FORMS = {
    "tri_test": [{}, {"EDGES_PER_CYCLE": 3}],
    "lod_test": [{}, {"EDGES_PER_CYCLE": 3}],
    "child_test": [{}, {"BOXES_PER_CYCLE": 4}, {"BOXES_PER_CYCLE": 1}],
    "hit_divide": [{}, {"DIVIDE_BITS": 2}, {"DIVIDE_BITS": 1}],
    "ray_setup": [{}, {"SETUP_BITS": 2}, {"SETUP_BITS": 1}],
}
# Blocks of one kind that take turns.
COPIES = {"setup_copies": [{"COPIES": copies} for copies in (2, 3, 4)], "divide_copies": [{"COPIES": copies} for copies in (2, 3, 4)]}
# Modules without a twin there that are worth a row.
WHOLE = "traversal_unit"
FURTHER = ["edge_function", "traversal_stack", "ray_context", WHOLE]
# What a traversal unit has one of each of.
OF_UNIT = ["ray_setup", "node_address", "child_test", "lod_test", "tessellate", "tri_test", "hit_divide", "hit_select", "bary_map"]
# A memory: an array of registers that are written one word at a time.
MEMORY = re.compile(r"^\s*logic (?:\[[^\]]*\] *)*\w+_q +\[", re.MULTILINE)


@dataclasses.dataclass(frozen=True)
class Block:
    """A module with its parameters, and with another package than that of rtl/ if there is one."""

    module: str
    parameters: tuple = ()
    package: str = ""

    @property
    def name(self):
        """Its name in tables, on the command line and in file names."""
        return "-".join([self.module, *(f"{name}={value}" for name, value in self.parameters)])

    def sources(self):
        """Its files, the package first, then by name: the closure of the modules named in them (a file bears its module's name)."""
        known = {path.stem: path for path in RTL.glob("*.sv")}
        if self.package:
            known[PACKAGE] = ROOT / self.package
        if self.module not in known:
            raise Failure(f"rtl/{self.module}.sv is missing")
        needed, waiting = set(), [PACKAGE, self.module]
        while waiting:
            name = waiting.pop()
            if name not in needed:
                needed.add(name)
                code = re.sub(r"//.*", "", known[name].read_text(encoding="utf-8"))
                waiting += [word for word in set(re.findall(r"\w+", code)) if word in known]
        return [known[name].relative_to(ROOT) for name in [PACKAGE, *sorted(needed - {PACKAGE})]]

    def ingredients(self):
        """All that its synthesis depends on but for the tools."""
        package, *others = ((ROOT / path).read_text(encoding="utf-8") for path in self.sources())
        # Of the package what the block uses: another hardware is the same block if it differs in other things.
        return {"module": self.module, "parameters": self.parameters, "sources": [used(package, "\n".join(others)), *others]}

    def has_memories(self):
        """Whether there are any in it."""
        return any(MEMORY.search((ROOT / path).read_text(encoding="utf-8")) for path in self.sources())

    def read(self):
        """Yosys commands that read it and make it the top, under its module's name."""
        files = " ".join(map(str, self.sources()))
        parameters = " ".join(f"-chparam {name} {value}" for name, value in self.parameters)
        return [f"read_verilog -sv {files}", f"hierarchy -check -top {self.module} {parameters}", f"rename -top {self.module}"]


def used(package, code):
    """The items of the package that the code uses, and those that they use."""
    text = re.sub(r"//.*", "", package)
    items = {}
    for item in re.finditer(r"^  (?:localparam .*?;|typedef .*?^  } \w+;|function .*?^  endfunction)", text, re.MULTILINE | re.DOTALL):
        named = re.match(r"  localparam [^=]*?(\w+) =|  typedef .*} (\w+);$|  function [^(]*?(\w+)\(", item[0], re.DOTALL)
        items[next(name for name in named.groups() if name)] = item[0]
    needed, waiting = set(), set(re.findall(r"\w+", re.sub(r"//.*", "", code)))
    while waiting:
        needed |= waiting & items.keys()
        waiting = {word for name in waiting & items.keys() for word in re.findall(r"\w+", items[name])} - needed
    return [items[name] for name in sorted(needed)]


def contexts():
    """Contexts of the unit as rtl/ has it."""
    package = (RTL / f"{PACKAGE}.sv").read_text(encoding="utf-8")
    return int(re.search(r"localparam int unsigned CONTEXTS = (\d+);", package)[1])


def twins():
    """The modules with a Rust twin."""
    return sorted(path.stem for path in (ROOT / "src/block").glob("*.rs") if path.stem not in ("mod", "operation"))


def every():
    """Every block."""
    return [Block(name, tuple(form.items())) for name in twins() + FURTHER + list(COPIES) for form in (FORMS | COPIES).get(name, [{}])]


def chosen(names):
    """The blocks of these names: a module's name means all its forms; any module of rtl/ will do."""
    found = []
    for name in names:
        known = [block for block in every() if name in (block.module, block.name)]
        module, *parameters = name.split("-")
        exact = [block for block in known if block.name == name and block.parameters]
        found += exact or known or [Block(module, tuple(tuple(given.split("=", 1)) for given in parameters))]
    return found
