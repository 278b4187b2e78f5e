"""The line of progress: seldom enough to read, often enough to know that it goes on."""

from __future__ import annotations

import time

import pytest

from gaitsim.cli.progress import ProgressLine
from gaitsim.optimization.search import Progress


class Clock:
    """Time as the test says it."""

    def __init__(self) -> None:
        self.now = 100.0

    def __call__(self) -> float:
        return self.now


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    found = Clock()
    monkeypatch.setattr(time, "monotonic", found)
    return found


def test_a_plain_line_each_few_seconds_also_within_a_generation(
    clock: Clock, capsys: pytest.CaptureFixture[str]
) -> None:
    line, progress = ProgressLine(4), Progress(evaluations=1, asked=10)
    for _ in range(24):  # two of the first generation, four seconds each
        clock.now += 0.5
        progress.arrived += clock.now % 4 == 0
        progress.evaluated_now += clock.now % 4 == 0
        line.update(progress)
    begin = "generation 0/4  best -  "
    assert capsys.readouterr().err.splitlines() == [
        f"{begin}2 evaluations, 0 failed, 0.2/s, 3:15 left at most",
        f"{begin}3 evaluations, 0 failed, 0.2/s, 3:10 left at most",
    ]


def test_the_end_is_always_said_and_nothing_is_said_twice(clock: Clock, capsys: pytest.CaptureFixture[str]) -> None:
    line, progress = ProgressLine(4), Progress(generation=4, evaluations=41, evaluated_now=41)
    clock.now += 2
    line.update(progress)
    line.update(progress)
    line.close()
    said = "generation 4/4  best -  41 evaluations, 0 failed, 20.5/s, 0:00 left at most\n"
    assert capsys.readouterr().err == said


def test_what_was_in_the_journal_makes_no_speed(clock: Clock, capsys: pytest.CaptureFixture[str]) -> None:
    line, progress = ProgressLine(4), Progress(generation=3, evaluations=31)
    clock.now += 6
    line.update(progress)
    assert capsys.readouterr().err == "generation 3/4  best -  31 evaluations, 0 failed, 0.0/s, - left at most\n"
