"""Replays to draw: of specs in the archive, of specs written in a test, and of results made for it."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import pytest

from gaitsim.analysis.replays.replay import Replay, replayed
from gaitsim.cli.main import main
from gaitsim.study.opened import open_result
from gaitsim.study.replays import replay_of
from tests.simulation.models import ROOT, model, written

Settings = Iterable[tuple[str, str]]


def of_spec(name: str, settings: Settings = ()) -> Replay:
    """A spec of the archive, at its own values."""
    path = ROOT / "specs" / f"{name}.yaml"
    return replayed(model(path, settings), path)


def of_text(text: str, settings: Settings = ()) -> Replay:
    """A spec written in a test."""
    return replayed(written(text, settings), Path("spec.yaml"))


def of_result(folder: Path) -> Replay:
    """The best candidate of a result."""
    return replay_of(open_result(folder, (), True, "best"), folder)


def cut(replay: Replay, count: int) -> Replay:
    """The same run with its first instants only."""
    from dataclasses import replace

    whole = replay.trajectory
    part = replace(whole, times=whole.times[:count], values=whole.values[:count])
    return replace(replay, outcome=replace(replay.outcome, trajectory=part))


def command(*words: str) -> int:
    """Run a command of gaitsim in this process; its exit code."""
    with pytest.raises(SystemExit) as ended:
        main(list(words))
    return int(ended.value.code or 0)
