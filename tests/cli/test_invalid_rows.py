"""A study of which some rows are invalid: each costs only itself."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from .commands import gaitsim

SPEC = """gaitsim: 1
parts:
  pendulum: {use: segment/rod, mass: 2 kg, length: 1 m}
  pivot: {use: joint/hinge, parent: world, child: pendulum.proximal}
initial: {pivot.angle: 170 deg}
measures:
  swing: {use: measure/range, signal: {from: pivot.angle}}
simulate: {duration: 0.1 s, step: 1 ms}
"""
OUTSIDE = '"0 kg" is outside 1e-06 to 1000 kg; choose a value between.'


@pytest.fixture(autouse=True)
def in_a_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("spec.yaml").write_text(SPEC, encoding="utf-8")


def test_an_invalid_row_costs_only_itself(capsys: pytest.CaptureFixture[str]) -> None:
    said = gaitsim(capsys, "run", "spec.yaml", "--vary", "pendulum.mass=1 kg,0 kg,4 kg", "--json")
    data = json.loads(said.out)
    assert (said.code, data["status"]) == (0, "completed")
    assert [row["status"] for row in data["rows"]] == ["completed", "failed", "completed"]
    assert data["rows"][1]["reason"] == f"--vary pendulum.mass=0 kg: pendulum.mass: {OUTSIDE}"
    assert "pendulum.mass = 0 kg: failed: --vary pendulum.mass=0 kg" in said.err
    assert gaitsim(capsys, "results", "verify", data["result"]).code == 0
    alone = gaitsim(capsys, "run", data["result"], "--candidate", "3", "--no-save", "--json")
    assert json.loads(alone.out)["metrics"] == data["rows"][2]["metrics"]


def test_a_row_that_no_mechanics_can_be_made_of_costs_only_itself(capsys: pytest.CaptureFixture[str]) -> None:
    space = "joint/spatial_hinge, axis_left: 1, axis_up: 0, upper: 3 rad"
    Path("space.yaml").write_text(SPEC.replace("joint/hinge", space).replace("170", "20"), encoding="utf-8")
    said = gaitsim(capsys, "run", "space.yaml", "--vary", "pivot.axis_left=0,1", "--no-save", "--json")
    rows = json.loads(said.out)["rows"]
    assert [row["status"] for row in rows] == ["failed", "completed"]
    assert "space.yaml:4:3: pivot: its axis has no length" in rows[0]["reason"]


def test_a_row_whose_start_cannot_be_meant_costs_only_itself(capsys: pytest.CaptureFixture[str]) -> None:
    limited = SPEC.replace(
        "joint/hinge", "joint/limited_hinge, stiffness: 500 N m/rad, lower: -60 deg, upper: 60 deg"
    ).replace("170", "20")
    Path("limited.yaml").write_text(limited, encoding="utf-8")
    words = ("--vary", "initial.pivot.angle=20 deg,20 rad", "--no-save", "--json")
    rows = json.loads(gaitsim(capsys, "run", "limited.yaml", *words).out)["rows"]
    assert [row["status"] for row in rows] == ["completed", "failed"]
    assert "pivot.angle: at the start this is" in rows[1]["reason"]


def test_draws_of_a_study_with_an_invalid_row_are_refused(capsys: pytest.CaptureFixture[str]) -> None:
    Path("study.yaml").write_text(SPEC + "study: [{pendulum.mass: 0 kg}, {pendulum.mass: 1 kg}]\n", encoding="utf-8")
    said = gaitsim(capsys, "run", "study.yaml", "--draws", "2", "--no-save")
    assert (said.code, said.out) == (3, "")
    assert f"pendulum.mass: {OUTSIDE}" in said.err


def test_a_study_of_invalid_rows_only_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    said = gaitsim(capsys, "run", "spec.yaml", "--vary", "pendulum.mass=0 kg,-1 kg")
    assert (said.code, said.out, said.err) == (3, "", f"--vary pendulum.mass=0 kg: pendulum.mass: {OUTSIDE}\n")
    assert not Path("results").exists()
