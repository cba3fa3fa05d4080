"""From a property to Yosys' SMT-LIB to z3's verdict."""

import re
import shutil
import subprocess
import time

from .properties import FORMAL, Verdict
from .tools import OUT, ROOT, RTL, Failure

# Signs that Yosys took something for something else: never let pass.
SUSPECT = ("implicitly declared", "no driver", "Warning:")


def closure(roots, texts):
    """`roots` and the modules that they are made of, all the way down, sorted."""
    seen, queue = set(), [name for name in roots if name in texts]
    while queue:
        name = queue.pop()
        if name not in seen:
            seen.add(name)
            queue += [word for word in re.findall(r"^\s*(\w+)\s*(?:#\(|\w+\s*\()", texts[name], re.M) if word in texts]
    return sorted(seen)


class Solver:
    """Writes, runs and reads one case after the other."""

    def __init__(self, tools, keep):
        self.tools, self.keep = tools, keep
        self.rtl = {path.stem: path.read_text(encoding="utf-8") for path in RTL.glob("*.sv")}

    def cases(self, one):
        """The cases of a property: functions that return verdict by verdict."""
        yield lambda: self.timed("proof", "proved", self.proof, one)
        yield lambda: self.timed("cover", "reached", self.cover, one)
        for number in range(len(one.mutants)):
            yield lambda number=number: self.timed("mutant", "rejected", self.mutant, one, number)

    @staticmethod
    def timed(kind, wanted, case, *arguments):
        """The verdict of a case; one that cannot be tried says why and leaves the others alone."""
        started = time.monotonic()
        try:
            got, trace = case(*arguments)
        except Failure as why:
            got, trace = f"error: {why}", ""
        return Verdict(kind, got, wanted, time.monotonic() - started, trace)

    def proof(self, one):
        """The asserts hold."""
        model = self.model(one, "proof")
        last = one.induction
        goals = [f"({model.name('a', number)} s{last})" for number in range(model.asserts)] if one.apart else [model.holds(last)]
        if not last:
            before, step, queries = model.one_state(), "proof", []
        else:
            queries = [("base", model.states(last, True) + [model.broken(last)])]
            before, step = model.states(last + 1, False) + [f"(assert {model.holds(k)})" for k in range(last)], "step"
        queries += [(step, before + [f"(assert (not {goal}))"]) for goal in goals]
        for name, query in queries:
            got, trace = self.ask(model, name, query, one.limit)
            if got != "unsat":
                return {"sat": f"fails ({name})"}.get(got, got), trace
        return "proved", ""

    def cover(self, one):
        """Every cover is reached."""
        model = self.model(one, "cover")
        if not model.covers:
            return "no cover statement", ""
        steps = one.reach if one.induction else 1
        states = model.states(steps, True) if one.induction else model.one_state()
        for number in range(model.covers):
            somewhere = " ".join(f"({model.name('c', number)} s{k})" for k in range(steps))
            got, _ = self.ask(model, f"cover{number}", states + [f"(assert (or {somewhere}))"], one.limit)
            if got != "sat":
                return {"unsat": f"never reached (cover {number})"}.get(got, got), ""
        return "reached", ""

    def mutant(self, one, number):
        """The mutant breaks an assert, from the start on."""
        model = self.model(one, f"mutant{number}", one.mutants[number])
        if one.induction:
            query = model.states(one.reach, True) + [model.broken(one.reach)]
        else:
            query = model.one_state() + [f"(assert (not {model.holds(0)}))"]
        got, _ = self.ask(model, "mutant", query, one.limit)
        return {"sat": "rejected", "unsat": "lives"}.get(got, got), ""

    def texts(self, one, mutant=None):
        """The modules that a property is made of, with or without a mutant: their texts by name."""
        texts = dict(self.rtl)
        for change in one.narrow + ((mutant,) if mutant else ()):
            texts[change.file] = change.apply(texts[change.file])
        if not one.inside:
            texts[one.top] = (FORMAL / one.file).read_text(encoding="utf-8")
        for helper in one.helpers:
            texts[helper] = (FORMAL / f"{helper}.sv").read_text(encoding="utf-8")
        for stub in one.stubs:
            texts[stub] = (FORMAL / f"{stub}_stub.sv").read_text(encoding="utf-8")
        for module in one.free:
            # Its ports are all that is needed.
            texts[module] = texts[module][: texts[module].index("\n);\n") + 4] + "endmodule\n"
        for fragment in one.fragments:
            head, end, tail = texts[fragment.inside].rpartition("\nendmodule")
            texts[fragment.inside] = f"{head}\n{(FORMAL / fragment.file).read_text(encoding='utf-8')}{end}{tail}"
        if not one.registers:
            wire = (FORMAL / "elastic_stub.sv").read_text(encoding="utf-8")
            for register in ("pipe_stage", "pipe_skid"):
                texts[register] = wire.replace("module elastic ", f"module {register} ")
        names = ["lod_pkg", *(name for name in closure([one.top], texts) if name != "lod_pkg")]
        if mutant and mutant.file not in names:
            raise Failure(f"{one.name} does not contain {mutant.file}, the file of its mutant")
        return {name: texts[name] for name in names}

    def model(self, one, variant, mutant=None):
        """Yosys' view of the property, with or without a mutant."""
        folder = OUT / one.name / variant
        shutil.rmtree(ROOT / folder, ignore_errors=True)
        (ROOT / folder).mkdir(parents=True)
        texts = self.texts(one, mutant)
        for name, text in texts.items():
            (ROOT / folder / f"{name}.sv").write_text(text, encoding="utf-8")
        self.yosys(one, folder, [str(folder / f"{name}.sv") for name in texts])
        return Model(one, folder, (ROOT / folder / "model.smt2").read_text(encoding="utf-8"))

    def yosys(self, one, folder, files):
        """Writes model.smt2 into the folder."""
        lines = [
            f"read_verilog -sv -formal -defer {' '.join(files)}",
            f"hierarchy -check -top {one.top}" + "".join(f" -chparam {name} {value}" for name, value in one.parameters),
            *(f"select -assert-min 1 t:*{module}*\ncutpoint t:*{module}*" for module in one.free),
            "proc",
            "flatten",
            # What a fragment names of a module inside is there, by that name.
            "select -assert-none a:hierconn",
            *(f"select -assert-count 1 w:{wire}\ncutpoint w:{wire}" for wire in one.cut),
            # Of what leads to outputs alone nothing is asked.
            "delete -output o:*",
            "opt_clean",
            "memory -nordff -nomap",
            "async2sync",
            "chformal -lower",
            "setundef -undriven -anyseq",
            "opt -keepdc -fast",
            "dffunmap",
            "opt_clean",
            f"write_smt2 -{'stdt' if one.memory else 'stbv'} {folder}/model.smt2",
        ]
        (ROOT / folder / "model.ys").write_text("\n".join(lines) + "\n", encoding="utf-8")
        command = [self.tools.yosys, "-q", "-l", f"{folder}/yosys.log", "-s", f"{folder}/model.ys"]
        got = subprocess.run([str(word) for word in command], cwd=ROOT, capture_output=True, text=True, errors="replace", check=False)
        said = got.stdout + got.stderr
        wrong = [line.strip() for line in said.splitlines() if "ERROR" in line or any(word in line for word in SUSPECT)]
        if got.returncode or wrong:
            raise Failure(f"{one.name}: Yosys: {(wrong or [f'ended with code {got.returncode}'])[0]}; see {folder}/yosys.log")

    def ask(self, model, name, query, limit):
        """(sat, unsat, `took over ... s` or an error; the counterexample in words)."""
        path = ROOT / model.folder / f"{name}.smt2"
        values = [f"({model.name('n', port)} s{k})" for k in range(model.asked) for port in model.inputs]
        text = ["(set-option :produce-models true)", model.text, *query, "(check-sat)"]
        path.write_text("\n".join(text + ([f"(get-value ({' '.join(values)}))"] if values else [])) + "\n", encoding="utf-8")
        try:
            got = subprocess.run([self.tools.z3, "-smt2", path], capture_output=True, text=True, timeout=limit, check=False)
        except subprocess.TimeoutExpired:
            return f"took over {limit} s", ""
        finally:
            if not self.keep:
                path.unlink()
        verdict, _, rest = got.stdout.partition("\n")
        if verdict == "sat":
            found = re.findall(r"\(\|\w+_n ([^|]+)\| (s\d+)\)\s+(#[xb][0-9a-f]+|true|false)\)", rest)
            return verdict, "".join(f"\n  {state} {port} = {value}" for port, state, value in found)
        if verdict == "unsat":
            return verdict, ""
        raise Failure(f"{model.property.name}: z3 says {got.stdout.strip()[:200]!r}; see {model.folder}/{name}.smt2 (--keep)")


class Model:
    """What Yosys wrote: its text, and the names of its predicates."""

    def __init__(self, one, folder, text):
        self.property, self.folder, self.text = one, folder, text
        top = re.search(r"^; yosys-smt2-topmod (\S+)", text, re.M) or re.search(r"^; yosys-smt2-module (\S+)", text, re.M)
        self.top = top.group(1)
        self.inputs = re.findall(r"^; yosys-smt2-input (\S+) \d+", text, re.M)
        self.covers = len(re.findall(r"^; yosys-smt2-cover ", text, re.M))
        self.asserts = len(re.findall(r"^; yosys-smt2-assert ", text, re.M))
        self.asked = 1
        if not self.asserts:
            raise Failure(f"{one.name} asserts nothing")
        if not one.induction and re.search(r"^; yosys-smt2-register ", text, re.M):
            raise Failure(f"{one.name} has registers and must be proved by induction")

    def name(self, what, of=None):
        """The symbol of a predicate."""
        return f"|{self.top}_{what}|" if of is None else f"|{self.top}_{what} {of}|"

    def holds(self, state):
        """All asserts in a state."""
        return f"({self.name('a')} s{state})"

    def broken(self, states):
        """Some assert fails in one of the first states."""
        return f"(assert (not (and {' '.join(self.holds(k) for k in range(states))})))"

    def one_state(self):
        """One state under the assumptions."""
        self.asked = 1
        return [f"(declare-const s0 {self.name('s')})", f"(assert ({self.name('u')} s0))"]

    def states(self, count, from_start):
        """States that follow each other under the assumptions."""
        self.asked = count
        lines = []
        for k in range(count):
            lines += [f"(declare-const s{k} {self.name('s')})", f"(assert ({self.name('u')} s{k}))"]
            lines += [f"(assert ({self.name('t')} s{k - 1} s{k}))"] if k else []
        return lines + ([f"(assert ({self.name('i')} s0))"] if from_start else [])
