from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from gaitsim.analysis.replays.reference import metric_over
from gaitsim.analysis.report.facts import study_table
from gaitsim.analysis.searches.sweep import places, study_in, sweep_figures
from gaitsim.results.manifest import BadResult
from tests.analysis.replays import command, of_result, of_spec
from tests.simulation.models import ROOT

SPEC = str(ROOT / "specs" / "hopping_geyer2003.yaml")


@pytest.fixture
def studied(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):  # type: ignore[no-untyped-def]
    """Runs a study of the hopper and gives its result."""
    monkeypatch.chdir(tmp_path)

    def study(*words: str) -> Path:
        assert command("run", SPEC, "--set", "simulate.duration=8 s", *words) == 0
        return max((tmp_path / "results").iterdir(), key=lambda path: path.stat().st_mtime)

    return study


def test_texts_become_places_in_one_unit() -> None:
    found = places(["1", "2.5"])
    assert found is not None and found[0].tolist() == [1, 2.5] and found[1] == "1"
    found = places(["5 ms", "0.02 s"])
    assert found is not None and found[0].tolist() == pytest.approx([5, 20]) and found[1] == "ms"
    assert places(["slow", "fast"]) is None
    assert places(["1 m", "1 s"]) is None
    assert places([None, "1"]) is None


def test_a_gain_sweep_lies_on_the_reference(studied) -> None:  # type: ignore[no-untyped-def]
    replay = of_result(studied("--vary", "feedback.gain=1,2.4,2.64,4,10,15"))
    found = {d.name: d for d in sweep_figures(replay)}
    assert {"sweep_apex_height", "sweep_contact_time", "sweep_peak_force", "sweep_hopping_frequency"} <= found.keys()
    axes = found["sweep_apex_height"].figure.axes
    assert [a.get_ylabel() for a in axes] == ["apex_height (m)", "spread (m)", "hops (–)"]
    assert axes[-1].get_xlabel() == "feedback.gain (–)"
    lines = {line.get_label(): line for line in axes[0].lines}
    ours = dict(zip(*lines["this study"].get_data(), strict=True))
    for gain, height in zip(*lines["reference"].get_data(), strict=True):
        if gain in ours:
            assert ours[gain] == pytest.approx(height, abs=1.5e-3)
    assert "1 of the 6 rows did not complete (×: stopped)" in found["sweep_apex_height"].caption
    assert "Squares: an independent solution" in found["sweep_apex_height"].caption
    table = study_table(replay)
    assert table is not None
    assert table.columns[:3] == ("feedback.gain", "status", "apex_height (m)")
    assert [row[:2] for row in table.rows[:2]] == [("1", "stopped"), ("2.4", "completed")]
    assert table.rows[0][2] == "–"


def test_two_varied_numbers_give_a_line_each(studied) -> None:  # type: ignore[no-untyped-def]
    vary = ("--vary", "feedback.gain=2,3,4", "--vary", "simulate.step=1 ms,0.5 ms")
    (figure,) = (d.figure for d in sweep_figures(of_result(studied(*vary))) if d.name == "sweep_apex_height")
    labels = figure.axes[0].get_legend_handles_labels()[1]
    assert labels[:2] == ["simulate.step = 1 ms", "simulate.step = 0.5 ms"]
    assert len(figure.axes[0].lines[0].get_xdata()) == 3


def test_times_have_their_unit(studied) -> None:  # type: ignore[no-untyped-def]
    drawings = sweep_figures(of_result(studied("--vary", "simulate.step=1 ms,0.5 ms")))
    assert drawings[0].figure.axes[-1].get_xlabel() == "simulate.step (ms)"


def test_words_are_names_of_places(studied) -> None:  # type: ignore[no-untyped-def]
    drawings = sweep_figures(of_result(studied("--vary", "extensor.use=muscle/geyer2003,muscle/geyer2010")))
    labels = [label.get_text() for label in drawings[0].figure.axes[-1].get_xticklabels()]
    assert labels == ["muscle/geyer2003", "muscle/geyer2010"]


def test_one_run_is_no_study(studied) -> None:  # type: ignore[no-untyped-def]
    folder = studied()
    assert study_in(folder) is None
    assert sweep_figures(of_result(folder)) == []
    assert sweep_figures(of_spec("pendulum_pid")) == []


def test_a_damaged_study_is_said(tmp_path: Path) -> None:
    (tmp_path / "evaluations.jsonl").write_text('{"settings": {}, "metrics": {}, "status"')
    with pytest.raises(BadResult, match="restore it from a copy"):
        study_in(tmp_path)


def test_metrics_that_are_not_there_are_nan(tmp_path: Path) -> None:
    row = {"status": "failed", "score": None, "steps": 0}
    rows = [
        row | {"settings": {"gain": "1"}, "metrics": {}},
        row | {"settings": {"gain": "2"}, "metrics": {"height": None}},
        row | {"settings": {"gain": "3"}, "metrics": {"height": 0.5}},
    ]
    (tmp_path / "evaluations.jsonl").write_text("".join(json.dumps(r) + "\n" for r in rows))
    study = study_in(tmp_path)
    assert study is not None
    assert study.varied == ["gain"]
    assert np.isnan(study.column("height")).tolist() == [True, True, False]


def test_the_reference_values_ship_with_the_spec() -> None:
    replay = of_spec("hopping_geyer2003", [("simulate.duration", "0.1 s")])
    known = metric_over(replay, "feedback.gain", "apex_height")
    assert known is not None
    assert known.points[0].tolist() == [1.5, 2.4, 2.64, 4, 10, 15]
    assert known.points[1].max() == 0.163
    assert metric_over(replay, "feedback.bias", "apex_height") is None
    assert metric_over(of_spec("pendulum_pid"), "balance.proportional", "angle") is None
