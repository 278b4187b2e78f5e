"""gaitsim view where no window can be opened: what is said, and with which exit code."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.cli.commands import gaitsim

PENDULUM = Path(__file__).resolve().parents[2] / "specs" / "pendulum_pid.yaml"


@pytest.fixture(autouse=True)
def no_display(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)


def test_without_a_display_a_video_is_the_next_move(capsys: pytest.CaptureFixture[str]) -> None:
    said = gaitsim(capsys, "view", str(PENDULUM))
    assert said.code == 4
    assert said.err == f"there is no display for a window; make a video instead: gaitsim analyze {PENDULUM}\n"


def test_a_display_that_is_not_there_is_no_display(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("DISPLAY", ":4711")
    said = gaitsim(capsys, "view", str(PENDULUM))
    assert said.code == 4
    told = "no window with OpenGL can be opened on this display; make a video instead"
    assert said.err == f"{told}: gaitsim analyze {PENDULUM}\n"


def test_a_speed_is_above_zero(capsys: pytest.CaptureFixture[str]) -> None:
    said = gaitsim(capsys, "view", str(PENDULUM), "--speed", "0")
    assert (said.code, said.err) == (2, "--speed 0: seconds of motion in a second, above 0, such as 0.25.\n")


def test_a_candidate_belongs_to_a_result(capsys: pytest.CaptureFixture[str]) -> None:
    said = gaitsim(capsys, "view", str(PENDULUM), "--candidate", "best")
    assert said.code == 2
    assert "candidates belong to results" in said.err
