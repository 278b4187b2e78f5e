"""Draws, looked at: their numbers over all of them, their figure and their table."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from gaitsim.analysis.report.facts import study_table
from gaitsim.analysis.report.figures import FIGURES
from gaitsim.analysis.searches.draws import Summary, draws_figures, draws_of, summaries
from gaitsim.analysis.searches.sweep import sweep_figures
from tests.analysis.replays import command, of_result, of_spec
from tests.simulation.models import ROOT

SPEC = str(ROOT / "specs" / "hopping_leg_mass.yaml")


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    words = ("--draws", "20", "--within", "2 %", "--set", "simulate.duration=3 s")
    assert command("run", SPEC, *words) == 0
    (made,) = (tmp_path / "results").iterdir()
    return made


def test_mean_least_and_greatest_of_what_is_finite() -> None:
    rows = [{"a": 1.0, "b": math.nan}, {"a": 4.0, "b": 2.0}, {}, {"a": -2.0, "b": math.inf, "c": math.nan}]
    first, second, third = summaries(rows)
    assert first == Summary("a", 1.0, -2.0, 4.0, 3)
    assert second == Summary("b", 2.0, 2.0, 2.0, 1)
    assert (third.name, third.count) == ("c", 0)
    assert math.isnan(third.mean) and math.isnan(third.least) and math.isnan(third.greatest)
    assert summaries([]) == []


def test_a_point_a_draw_and_a_cross_for_a_fall(folder: Path) -> None:
    replay = of_result(folder)
    drawn = draws_of(replay)
    assert drawn is not None and draws_figures in FIGURES
    (drawing,) = draws_figures(replay)
    fallen = drawn.statuses.count("stopped")
    assert 0 < fallen < 20 and drawn.completed == 20 - fallen
    words = f"{20 - fallen} of 20 draws completed; in each, every tuned value changed by up to 2 % (uniform, seed 1)."
    assert drawing.caption.startswith(words) and "Crosses: stopped before the end." in drawing.caption
    seen = [axes for axes in drawing.figure.axes if axes.get_visible()]
    assert "hop (m)" in [axes.get_xlabel() for axes in seen]
    hop = next(axes for axes in seen if axes.get_xlabel() == "hop (m)")
    mean, kept, lost = hop.lines
    assert mean.get_xdata()[0] == pytest.approx(sum(drawn.column("hop")) / 20, rel=1e-12)
    assert (len(kept.get_xdata()), len(lost.get_xdata())) == (20 - fallen, fallen)
    assert [int(number) - 1 for number in lost.get_ydata()] == [
        i for i, status in enumerate(drawn.statuses) if status == "stopped"
    ]
    assert sweep_figures(replay) == []


def test_the_table_of_the_report_has_a_row_a_metric(folder: Path) -> None:
    replay = of_result(folder)
    table = study_table(replay)
    assert table is not None
    assert table.columns == ("metric", "mean", "least", "greatest", "unit")
    assert [row[0] for row in table.rows] == list(replay.model.metrics)
    assert replay.notices[0].endswith(tuple(f": draw {k}" for k in range(1, 21)))
    assert not any("differs" in notice for notice in replay.notices)


def test_what_holds_no_draws_has_no_figure(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert draws_figures(of_spec("pendulum_pid")) == []
    monkeypatch.chdir(tmp_path)
    assert command("run", SPEC, "--set", "simulate.duration=0.1 s") == 0
    (made,) = (tmp_path / "results").iterdir()
    assert draws_figures(of_result(made)) == []
