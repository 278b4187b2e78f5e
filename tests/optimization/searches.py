"""A small search in a folder of its own, run as a researcher would: by the command."""

from __future__ import annotations

import contextlib
import hashlib
import io
import json
import os
import subprocess
import sys
import time
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from unittest import mock

import pytest

from gaitsim.cli.main import main

GAITSIM = str(Path(sys.executable).with_name("gaitsim"))
SPEC = """\
gaitsim: 1
parts:
  pendulum: {use: segment/rod, mass: 2 kg, length: 1 m}
  pivot: {use: joint/hinge, parent: world, child: pendulum.proximal}
  balance:
    use: controller/pid
    proportional: {value: 60 N m/rad, tune: [20 N m/rad, 200 N m/rad]}
    derivative: {value: 12 N m s/rad, tune: [0 N m s/rad, 50 N m s/rad]}
    setpoint: 180 deg
    limit: 40 N m
    angle: {from: pivot.angle, delay: 20 ms}
    angular_velocity: {from: pivot.velocity, delay: 20 ms}
    to: pivot.torque
  trap: {use: trap/none, level: {value: 0.4, tune: [0, 1], spread: 0.3}}
initial: {pivot.angle: 170 deg}
measures:
  angle: {use: measure/range, signal: {from: pivot.angle}}
objective: {use: objective/minimize, value: {from: angle}}
simulate: {duration: 2 s, step: 1 ms}
optimize: {population: 6, generations: 4}
"""
_TRAP = '''\
import math

from gaitsim.component import Component, Output, Parameter, State


def deep(level):
    if level < 0.0:
        return level
    return deep(level + 1.0) + 1.0


class Trap(Component):
    """Does what no component should do, above a level."""

    level = Parameter("1", "Where the search is.", bounds=(0, 1))
    count = State("1", "Steps.")
    value = Output("1", "Steps.")

    @staticmethod
    def output(p, u, x, y):
        y.value = x.count

    @staticmethod
    def update(p, u, x, y, dt):
        x.count = x.count + 1
        if p.level > 0.7:
            ACT
'''
TRAPS = {
    "none": "x.count = x.count + 1.0",
    "raises": 'raise ValueError("too much")',
    "infinite": "x.count = math.sqrt(0.5 - p.level)",
    "kills": "x.count = deep(p.level)",
    "hangs": "while x.count < 1e300 * p.level:\n                x.count = x.count * 1.0",
    "stops": "breakpoint()",
    "warns": "x.count = x.count / (0.0 * p.level)",
}


def signed(line: str, **changes: Any) -> str:
    """A line of a journal with other content, and a digest that fits."""
    data = json.loads(line) | changes
    del data["digest"]
    text = json.dumps(data)[:-1]
    return f'{text}, "digest": "{hashlib.sha256(text.encode()).hexdigest()[:16]}"}}\n'


@dataclass
class Ended:
    """How a command ended."""

    code: int
    out: str
    err: str

    @property
    def data(self) -> Any:
        return json.loads(self.out)


@dataclass
class Study:
    """A folder with a spec, the components beside it, and results."""

    folder: Path
    environment: dict[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        traps = self.folder / "components" / "trap"
        traps.mkdir(parents=True, exist_ok=True)
        (self.folder / "spec.yaml").write_text(SPEC)
        for name, act in TRAPS.items():
            (traps / f"{name}.py").write_text(_TRAP.replace("ACT", act))
        self.environment = {**os.environ, "GAITSIM_STATE": str(self.folder / "state"), **self.environment}

    def start(self, *words: str, **options: Any) -> subprocess.Popen[str]:
        pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "stdin": subprocess.PIPE, "text": True}
        return subprocess.Popen([GAITSIM, *words], cwd=self.folder, env=self.environment, **(pipes | options))

    def run(self, *words: str) -> Ended:
        """A command in this process, as if it were begun in the folder: most tests need no other."""
        out, err = io.StringIO(), io.StringIO()
        with (
            contextlib.chdir(self.folder),
            mock.patch.dict(os.environ, self.environment),
            contextlib.redirect_stdout(out),
            contextlib.redirect_stderr(err),
            pytest.raises(SystemExit) as ended,
        ):
            main(list(words))
        assert "Traceback" not in err.getvalue(), err.getvalue()
        return Ended(int(ended.value.code or 0), out.getvalue(), err.getvalue())

    def run_apart(self, *words: str, said: str | None = None, seconds: float = 120) -> Ended:
        """A command in a process of its own."""
        process = self.start(*words)
        out, err = process.communicate(said, timeout=seconds)
        assert "Traceback" not in err, err
        return Ended(process.returncode, out, err)

    def optimize(self, *words: str) -> Ended:
        return self.run("optimize", "spec.yaml", *words)

    @property
    def results(self) -> list[Path]:
        return sorted((self.folder / "results").glob("*"), key=lambda path: path.stat().st_mtime)

    @property
    def result(self) -> Path:
        """The only result."""
        (found,) = self.results
        return found

    def history(self, result: Path | None = None) -> tuple[bytes, bytes]:
        """What must be the same however a search ran."""
        folder = result or self.result
        assert not (folder / "arriving.jsonl").exists()
        return (folder / "evaluations.jsonl").read_bytes(), (folder / "generations.csv").read_bytes()

    def manifest(self) -> Any:
        return json.loads((self.result / "manifest.json").read_text())

    def listed(self) -> str:
        """The state of the only result, as `results list` says it."""
        (row,) = self.run("results", "list", "--json").data["results"]
        return str(row["status"])

    def wait_to_run(self, process: subprocess.Popen[str], seconds: float = 60) -> None:
        """Until a search that gives nothing is about to evaluate its first candidate."""
        end = time.monotonic() + seconds
        while not any((folder / "timings.csv").exists() for folder in self.results):
            assert process.poll() is None, process.communicate()
            assert time.monotonic() < end, "no beginning"
            time.sleep(0.01)
        time.sleep(0.2)

    def timed(self) -> list[tuple[str, ...]]:
        """Generation and index of every evaluation that was made, in any session."""
        rows = (self.result / "timings.csv").read_text().splitlines()
        assert rows[0] == "generation,index,seconds,host"
        return [tuple(row.split(",")[:2]) for row in rows[1:]]

    def arrived(self) -> int:
        """How many evaluations the journal holds by now."""
        found = set()
        for folder in (self.folder / "results").glob("*"):
            for name in ("evaluations.jsonl", "arriving.jsonl"):
                # A folder gets its name, and a line its place, while we look.
                with contextlib.suppress(FileNotFoundError):
                    for line in (folder / name).read_text().split("\n")[:-1]:
                        data = json.loads(line)
                        found.add((data["generation"], data["index"]))
        return len(found)

    def wait_for(self, evaluations: int, process: subprocess.Popen[str], seconds: float = 60) -> None:
        """Until so many evaluations have arrived."""
        end = time.monotonic() + seconds
        while self.arrived() < evaluations:
            assert process.poll() is None, process.communicate()
            assert time.monotonic() < end, "no progress"
            time.sleep(0.005)
