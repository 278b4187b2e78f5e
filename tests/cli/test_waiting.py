"""Long commands say where they are, also where stderr is a file; and a long table is thinned."""

from __future__ import annotations

import csv
import time
from pathlib import Path

import pytest

from gaitsim.cli import console
from tests.cli.commands import gaitsim

SPEC = Path(__file__).resolve().parents[2] / "specs" / "pendulum_pid.yaml"


@pytest.fixture(autouse=True)
def _impatient(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(console, "PLAIN_EVERY", 0.02)


@pytest.mark.parametrize("quiet", [False, True])
def test_what_tells_nothing_of_itself_is_waited_for_aloud(quiet: bool, capsys: pytest.CaptureFixture[str]) -> None:
    with console.waiting("simulating", quiet):
        time.sleep(0.1)
    said = capsys.readouterr().err.splitlines()
    assert bool(said) is not quiet
    assert set(said) <= {"simulating: 0 s so far"}


@pytest.mark.parametrize("quiet", [False, True])
def test_steps_are_counted_every_few_seconds(quiet: bool, capsys: pytest.CaptureFixture[str]) -> None:
    report = console.progress("runs", quiet)
    report(1, 3)
    time.sleep(0.03)
    report(2, 3)
    report(3, 3)
    assert capsys.readouterr().err == ("" if quiet else "runs: 2 of 3\n")


def test_out_is_written_every_so_often(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    words = ("run", str(SPEC), "--no-save", "--set", "simulate.duration=0.1 s", "--out")
    assert gaitsim(capsys, *words, "all.csv").code == 0
    assert gaitsim(capsys, *words, "some.csv", "--every", "20 ms").code == 0
    every, some = (list(csv.reader(Path(name).read_text().splitlines())) for name in ("all.csv", "some.csv"))
    steps = (len(every) - 1) // 5
    assert len(some) == 6
    assert some == [every[0], *every[1::steps]]
