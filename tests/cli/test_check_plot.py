"""gaitsim check --plot: a picture of moment arms, and a warning where one changes its sign."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from gaitsim.cli.main import main

LEG = Path(__file__).resolve().parents[2] / "specs" / "hopping_leg_mass.yaml"
SLIPPING = 'extensor.path.side=[{on: thigh.distal, at: [7 cm, 0 m, 0 m]}]'


def check(*words: str) -> int:
    with pytest.raises(SystemExit) as ended:
        main(["check", str(LEG), *words])
    code = ended.value.code
    assert isinstance(code, int)
    return code


def test_a_picture_is_drawn_where_it_is_asked_for(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert check("--plot", "--folder", str(tmp_path / "pictures")) == 0
    picture = tmp_path / "pictures" / "hopping_leg_mass.moment_arms.png"
    assert picture.read_bytes()[:4] == b"\x89PNG"
    said = capsys.readouterr()
    assert said.err == f"drawn in {picture}\n"
    assert "valid" in said.out


def test_a_change_of_sign_is_a_warning(capsys: pytest.CaptureFixture[str]) -> None:
    assert check("--set", SLIPPING, "--json") == 0
    said = capsys.readouterr()
    (warning,) = json.loads(said.out)["warnings"]
    assert "extensor.path: the moment arm over knee changes sign at 119 deg (looked at: 30 to 140 deg)" in warning
    assert warning.endswith("wrap it around the joint, move its points or its side.")
    assert said.err.startswith("warning: ")


def test_without_doubts_nothing_is_said(capsys: pytest.CaptureFixture[str]) -> None:
    assert check("--json") == 0
    said = capsys.readouterr()
    assert json.loads(said.out)["warnings"] == []
    assert said.err == ""
