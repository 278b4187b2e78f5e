"""The walker with perturbations: unperturbed until they act, and changed by each of them."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from .commands import gaitsim

SPECS = Path(__file__).resolve().parents[2] / "specs"


@pytest.mark.slow
def test_the_perturbed_walker_is_the_walker_until_it_is_perturbed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    names = ("walking_geyer2010.yaml", "walking_geyer2010_perturbed.yaml")
    plain, perturbed = (
        json.loads(gaitsim(capsys, "run", str(SPECS / name), "--start", "--no-save", "--json").out) for name in names
    )
    assert perturbed["steps"] == plain["steps"] > 100
    assert perturbed["metrics"] == plain["metrics"]


@pytest.mark.parametrize(
    "setting",
    [
        "push.strength=300 N",
        "use_for.terrain.angle=2 deg",
        "use_for.terrain.rise=-2 cm",
        "felt_lean.standard_deviation=2 deg",
    ],
)
def test_each_perturbation_is_one_setting(
    setting: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    early = ["--set", "push.onset=0.1 s", "--set", "use_for.terrain.first=5 cm", "--set", "simulate.duration=0.6 s"]
    words = [str(SPECS / "walking_geyer2010_perturbed.yaml"), *early, "--no-save", "--json", "--start"]
    still, moved = (
        json.loads(gaitsim(capsys, "run", *words, *more).out)["metrics"] for more in ((), ("--set", setting))
    )
    assert moved["speed.distance"] != still["speed.distance"]
