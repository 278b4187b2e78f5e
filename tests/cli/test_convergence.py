"""gaitsim check --convergence: what a half and a quarter of the step change."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from gaitsim.analysis.models.step_convergence import Change

from .commands import gaitsim

ROOT = Path(__file__).resolve().parents[2]
# A pendulum that swings freely: its angle after 1 s converges as semi-implicit Euler does.
SWING = """
gaitsim: 1
parts:
  pendulum: {use: segment/rod, mass: 2 kg, length: 1 m}
  pivot: {use: joint/hinge, parent: world, child: pendulum.proximal, damping: 1 N m s/rad}
initial: {pivot.angle: 40 deg}
measures:
  swing: {use: measure/range, signal: {from: pivot.angle}}
simulate: {duration: 1 s, step: 2 ms}
"""


@pytest.fixture
def spec(tmp_path: Path) -> str:
    path = tmp_path / "swing.yaml"
    path.write_text(SWING, encoding="utf-8")
    return str(path)


def test_the_order_of_the_scheme_is_seen(spec: str, capsys: pytest.CaptureFixture[str]) -> None:
    said = gaitsim(capsys, "check", spec, "--convergence", "--json")
    assert said.code == 0
    (table,) = json.loads(said.out)["convergence"]
    assert table["steps"] == pytest.approx([2e-3, 1e-3, 0.5e-3])
    change = table["metrics"]["swing.change"]
    assert change["order"] == pytest.approx(1, abs=0.1)
    assert change["ratio"] == pytest.approx(2, abs=0.15)
    assert change["unit"] == "rad"
    assert len(change["values"]) == 3
    assert change["flag"] is None


def test_a_metric_that_changes_more_than_the_tolerance_is_flagged(
    spec: str, capsys: pytest.CaptureFixture[str]
) -> None:
    said = gaitsim(capsys, "check", spec, "--convergence", "--tolerance", "0.00001")
    assert said.code == 0
    assert "at 2 ms" in said.out and "at 0.5 ms" in said.out
    row = next(line for line in said.out.splitlines() if line.split()[:1] == ["swing.change"])
    assert row.rstrip().endswith("<")
    assert said.err.startswith("a quarter of the step changes more than 0.001 %, or has no value: ")
    assert "swing.change" in said.err


def test_without_the_option_nothing_is_simulated(spec: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert "convergence" not in json.loads(gaitsim(capsys, "check", spec, "--json").out)


def test_a_run_that_fails_is_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "wild.yaml"
    path.write_text(SWING.replace("step: 2 ms", "step: 100 ms").replace("damping: 1 ", "damping: 1000 "))
    said = gaitsim(capsys, "check", str(path), "--convergence", "--json")
    assert said.code == 0
    assert json.loads(said.out)["convergence"][0]["status"][0] in ("failed", "completed")


def test_every_run_of_a_study_has_its_table(spec: str, capsys: pytest.CaptureFixture[str]) -> None:
    path = Path(spec)
    path.write_text(SWING + "study: [{pivot.damping: 1 N m s/rad}, {pivot.damping: 2 N m s/rad}]\n", encoding="utf-8")
    said = gaitsim(capsys, "check", spec, "--convergence")
    assert said.out.count("swing.change") == 2
    assert "pivot.damping = 2 N m s/rad" in said.out


def test_the_tuned_values_are_used_as_run_would(capsys: pytest.CaptureFixture[str]) -> None:
    leg = ROOT / "specs" / "hopping_leg_mass.yaml"
    said = gaitsim(capsys, "check", str(leg), "--convergence", "--set", "simulate.duration=0.5 s", "--json")
    assert any("tuned values from" in notice for notice in json.loads(said.out)["notices"])


@pytest.mark.parametrize(
    ("values", "relative", "ratio", "order", "flag"),
    [
        ((1.04, 1.02, 1.01), 0.03 / 1.04, 2, 1, "changes by 2.88 %"),
        ((1.16, 1.04, 1.01), 0.15 / 1.16, 4, 2, "changes by 12.9 %"),
        ((5.0, 5.0, 5.0), 0, None, None, ""),
        ((0.0, 0.0, 0.0), 0, None, None, ""),
        ((1.0, 1.001, 1.0005), 0.0005 / 1.001, -2, None, ""),
        ((1.0, None, 1.0), None, None, None, "no value"),
    ],
)
def test_a_change_in_numbers(
    values: tuple[float | None, ...], relative: float | None, ratio: float | None, order: float | None, flag: str
) -> None:
    change = Change("metric", "1", values)
    assert change.relative == (None if relative is None else pytest.approx(relative))
    assert change.ratio == (None if ratio is None else pytest.approx(ratio))
    assert change.order == (None if order is None else pytest.approx(order))
    assert change.flag(0.01) == flag
