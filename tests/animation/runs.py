"""Runs to look at, made once for all tests of pictures."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from gaitsim.analysis.replays.replay import Replay, replayed
from tests.simulation.models import ROOT, model, written


@cache
def run_of(name: str, duration: float = 1.0) -> Replay:
    """The first seconds of a spec of the archive, at its own values."""
    path = ROOT / "specs" / f"{name}.yaml"
    return replayed(model(path), path, duration=duration)


def run_of_text(text: str) -> Replay:
    """A spec written in a test."""
    return replayed(written(text), Path("spec.yaml"))
