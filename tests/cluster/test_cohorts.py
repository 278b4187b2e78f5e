"""A cohort on a scheduler's workers, and one whose driver is killed."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from pathlib import Path

import pytest

from .servers import Servers

STONE = """
gaitsim: 1
parameters:
  body_height: {unit: m, default: 40 cm, bounds: [1 cm, 3 m], doc: How high it is held.}
parts:
  stone: {use: segment/point_mass, mass: 1 kg}
  guide: {use: joint/vertical, parent: world, child: stone.center}
initial: {guide.position: =body_height, guide.velocity: {value: 0 m/s, tune: [-1 m/s, 4 m/s], spread: 0.3 m/s}}
measures:
  landed: {use: measure/fall, height: {from: guide.position}, below: 0 m}
objective: {use: objective/maximize, value: {from: landed}}
simulate: {duration: 0.3 s, step: 20 us}
"""
BODIES = "name,height [m]\nlow,0.3\nhigh,0.6\ndeep,-1\n"
WORDS = ("stone.yaml", "bodies.csv", "--retune", "30", "--vary", "stone.radius=1 cm:5 cm:9")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "stone.yaml").write_text(STONE, encoding="utf-8")
    (tmp_path / "bodies.csv").write_text(BODIES, encoding="utf-8")
    return tmp_path


def started(folder: Path, *words: str) -> subprocess.Popen[bytes]:
    return subprocess.Popen([sys.executable, "-m", "gaitsim.cli.main", "cohort", *words], cwd=folder)


def rows(folder: Path, results: str) -> Path:
    (found,) = folder.glob(f"{results}/*[!.partial]/evaluations.jsonl")
    return found


@pytest.mark.slow
def test_workers_of_a_scheduler_give_the_same_bytes(folder: Path, shared: Servers) -> None:
    assert started(folder, *WORDS, "--workers", "0", "--results", "here").wait() == 0
    assert started(folder, *WORDS, *shared.words, "--results", "there").wait() == 0
    for name in ("evaluations.jsonl", "table.csv"):
        assert rows(folder, "here").with_name(name).read_bytes() == rows(folder, "there").with_name(name).read_bytes()


@pytest.mark.slow
def test_a_real_kill_loses_no_row_that_was_kept(folder: Path) -> None:
    assert started(folder, *WORDS, "--workers", "0", "--results", "whole").wait() == 0
    process = started(folder, *WORDS, "--workers", "2", "--results", "killed")
    while (
        not list(folder.glob("killed/*[!.partial]/evaluations.jsonl"))
        or rows(folder, "killed").read_bytes().count(b"\n") < 4
    ):
        assert process.poll() is None
        time.sleep(0.01)
    os.kill(process.pid, 9)
    process.wait()
    kept = rows(folder, "killed").read_bytes().splitlines()
    assert len(kept) < 27
    assert started(folder, str(rows(folder, "killed").parent), "--resume", "--workers", "2").wait() == 0
    assert rows(folder, "killed").read_bytes() == rows(folder, "whole").read_bytes()
    assert set(kept[:-1]) <= set(rows(folder, "killed").read_bytes().splitlines())
