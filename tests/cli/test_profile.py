"""gaitsim profile: the table, the data and the picture."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from gaitsim.analysis.models.costs import cost_figure
from gaitsim.simulation.profile import Cost, Profile

from .commands import gaitsim

SPEC = str(Path(__file__).resolve().parents[2] / "specs" / "pendulum_pid.yaml")
SHORT = (SPEC, "--set", "simulate.duration=0.1 s")


def test_the_table_and_what_measuring_costs(capsys: pytest.CaptureFixture[str]) -> None:
    said = gaitsim(capsys, "profile", *SHORT)
    head, *rows, last = said.out.splitlines()
    assert said.code == 0 and said.err == ""
    assert " ".join(head.split()) == "part component calls a step ns a step share"
    assert any(row.split()[:2] == ["balance", "controller/pid"] for row in rows)
    assert last.startswith("a step takes ") and last.endswith(" times as long with the stopwatch")


def test_data_by_component_and_a_picture(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    said = gaitsim(capsys, "profile", *SHORT, "--components", "--json", "--plot", "--folder", str(tmp_path))
    data = json.loads(said.out)
    assert data["plot"] == str(tmp_path / "pendulum_pid.profile.png")
    assert Path(data["plot"]).read_bytes().startswith(b"\x89PNG")
    names = [cost["part"] for cost in data["costs"]]
    assert "controller/pid" in names and "balance" not in names
    assert sum(cost["share"] for cost in data["costs"]) == pytest.approx(1)
    assert data["step_seconds"] > 0 and data["times_slower"] > 0 and data["steps"] == 100


def test_a_study_is_not_one_run(capsys: pytest.CaptureFixture[str]) -> None:
    said = gaitsim(capsys, "profile", SPEC, "--set", "study=[{balance.limit: 1 N m}, {balance.limit: 2 N m}]")
    move = "take one with --candidate, or drop it: --set study=null."
    assert (said.code, said.err) == (2, f"{SPEC} is a study of 2 runs; {move}\n")


def test_the_picture_has_the_largest_costs_and_tells_of_the_rest() -> None:
    costs = tuple(Cost(f"part_{i}", "muscle/geyer2010" if i % 2 else "MuJoCo", 1, 1e-9 * (40 - i)) for i in range(40))
    drawing = cost_figure(costs, Profile(costs, 1e-6, 1.5, 100), "walk")
    (axes,) = drawing.figure.axes
    assert [text.get_text() for text in axes.get_yticklabels()] == [f"part_{i}" for i in range(25)]
    assert [text.get_text() for text in axes.get_legend().get_texts()] == ["MuJoCo", "muscle"]
    assert [round(bar.get_width()) for bar in axes.patches] == list(range(40, 15, -1))
    assert "takes 1,000 ns as a whole. The other 15 take 120 ns." in drawing.caption
    assert "1.50 times as long" in drawing.caption
