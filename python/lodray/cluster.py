"""Shards of a sweep, an error-time or a stability on an engine that you have already, with one call.

    run = lodray.cluster.submit("sweep jobs.toml -o out", shards=100, executor=executor)
    run.result()                                        # waits, merges, and gives the folder: Path("out")

`executor` is whoever runs functions for you: submitit's AutoExecutor (Slurm), a dask.distributed.Client (dask-jobqueue gives them for
Slurm, PBS, SGE, LSF and others), or any executor of concurrent.futures. Each shard is a run of the program, `lodray ... --shard K/N`, so the
program and all files must be found under the same paths everywhere, and this package must be installed there. To hand in the same
command again does what is left, and nothing twice. docs/scale.md says what holds.
"""

from __future__ import annotations

import os
import shlex
import subprocess
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from lodray._lodray import LodrayError

__all__ = ["Run", "run_shard", "submit"]

_COMMANDS = ("sweep", "error-time", "stability")


def run_shard(program: str, words: Sequence[str], folder: str, threads: int | None) -> str:
    """Runs the program in a folder: what goes wrong in its words, or nothing. This is what executors are given."""
    environment = dict(os.environ)
    if threads is not None:
        environment["RAYON_NUM_THREADS"] = str(threads)
    try:
        done = subprocess.run([program, *words], cwd=folder, env=environment, stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False)
    except OSError as why:
        return f"{program}: {why}"
    if done.returncode == 0:
        return ""
    return (done.stderr.strip() or done.stdout.strip() or f"it ended with {done.returncode}").splitlines()[-1]


@dataclass
class Run:
    """Shards that were handed in."""

    program: str
    """The program that runs them."""
    words: list[str]
    """The command, split at blanks."""
    folder: Path
    """Where it runs."""
    shards: list[Any]
    """The engine's own handle of each shard: a future, or a job of submitit's."""
    errors: list[str | None] = field(default_factory=list)
    """What went wrong in each shard, once `result` has waited for it."""

    def wait(self) -> list[str | None]:
        """Waits until all shards have ended, well or not: what went wrong in each, in the program's words or the engine's."""
        self.errors = [self._ended(shard) for shard in self.shards]
        return self.errors

    def result(self) -> Path:
        """Waits for all shards and merges what they have found: the folder of the results, byte for byte those of one run on one computer.

        LodrayError if jobs are left, or failed: which, and why the first shard that went wrong did.
        """
        self.wait()
        out = _folder_of_results(self.words)
        why = run_shard(self.program, ["merge", out], str(self.folder), None)
        if why:
            wrong = [f"; shard {number}/{len(self.shards)}: {error}" for number, error in enumerate(self.errors, 1) if error]
            raise LodrayError(why + "".join(wrong[:1]))
        return self.folder / out

    @staticmethod
    def _ended(shard: Any) -> str | None:
        try:
            return shard.result() or None
        except Exception as why:  # noqa: BLE001: an engine's own, of whatever kind
            lines = str(why).strip().splitlines()
            return f"{type(why).__name__}: {lines[-1] if lines else ''}"


def submit(
    command: str | Sequence[str],
    *,
    shards: int,
    executor: Any,
    program: str | os.PathLike[str] = "lodray",
    folder: str | os.PathLike[str] = ".",
    threads: int | None = None,
) -> Run:
    """Hands in a command in so many shards.

    command: what the program is given, without its name: "sweep jobs.toml -o out", or a list of words. It is sweep, error-time or stability.
    shards: how many, 1 to 100000. A job of a cluster should have minutes to do.
    executor: whoever has `submit(function, *arguments)` and gives something with `result()`. With submitit all shards are one array of jobs.
    program: the program `lodray`, as workers find it. folder: where it runs. threads: of each shard; all cores if it is left out.
    """
    words = shlex.split(command) if isinstance(command, str) else [str(word) for word in command]
    if not words or words[0] not in _COMMANDS:
        raise LodrayError(f"command: must begin with one of {', '.join(_COMMANDS)}, but is {shlex.join(words)!r}")
    for option in ("--shard", "--threads"):
        if any(word == option or word.startswith(option + "=") for word in words):
            raise LodrayError(f"command: {option} must be left out: each shard is given its own")
    if not 1 <= shards <= 100_000:
        raise LodrayError(f"shards: must be 1 to 100000, but is {shards}")
    if threads is not None and threads < 1:
        raise LodrayError(f"threads: must be 1 or more, but is {threads}")
    _folder_of_results(words)
    program = os.fspath(program)
    # Paths with a folder in them are from here; names alone are looked for by whoever runs them.
    program = str(Path(program).resolve()) if os.sep in program else program
    own = Path(folder).resolve()
    each = [[*words, "--shard", f"{number}/{shards}"] for number in range(1, shards + 1)]
    if hasattr(executor, "map_array"):
        many = [program] * shards, each, [str(own)] * shards, [threads] * shards
        handles = list(executor.map_array(run_shard, *many))
    else:
        # dask gives a call that it has seen before the result of then.
        options = {"pure": False} if hasattr(executor, "scheduler_info") else {}
        handles = [executor.submit(run_shard, program, one, str(own), threads, **options) for one in each]
    return Run(program, words, own, handles)


def _folder_of_results(words: Sequence[str]) -> str:
    for word, following in zip(words, [*words[1:], ""]):
        if word in ("-o", "--out") and following:
            return following
        if word.startswith("--out=") and len(word) > len("--out="):
            return word.removeprefix("--out=")
        if word.startswith("-o") and not word.startswith("--") and len(word) > 2:
            return word.removeprefix("-o").removeprefix("=")
    raise LodrayError("command: the folder of the results is missing: -o FOLDER")
