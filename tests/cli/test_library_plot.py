"""gaitsim library show --plot: a part's curves, or why it has none."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from .commands import gaitsim


def test_a_picture_is_drawn_where_it_is_asked_for(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    said = gaitsim(capsys, "library", "show", "controller/pid", "--plot", "--folder", str(tmp_path / "pictures"))
    picture = tmp_path / "pictures" / "controller.pid.curves.png"
    assert picture.read_bytes()[:4] == b"\x89PNG"
    assert said.err == (
        f"proportional has no default; drawn at 1 N m/rad. Another: --set proportional=...\ndrawn in {picture}\n"
    )
    assert said.out.startswith("controller/pid ")


def test_a_parameter_is_set_with_its_unit(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = ["library", "show", "controller/pid", "--plot", "--folder", str(tmp_path), "--json"]
    said = gaitsim(capsys, *words, "--set", "proportional=2 N m/deg")
    assert said.err == f"drawn in {tmp_path / 'controller.pid.curves.png'}\n"
    assert json.loads(said.out)["plot"] == str(tmp_path / "controller.pid.curves.png")


@pytest.mark.parametrize(
    ("reference", "said"),
    [
        ("segment/thigh", "it is assembled of other parts; draw those: gaitsim library show segment/rod --plot"),
        ("measure/apex", "it watches a whole run and reports metrics of it, which are no curve"),
        ("path/sites", "it is mechanics alone, and MuJoCo computes all its numbers in a model"),
    ],
)
def test_a_part_without_curves_says_why(reference: str, said: str, capsys: pytest.CaptureFixture[str]) -> None:
    found = gaitsim(capsys, "library", "show", reference, "--plot", "--json")
    assert found.code == 0
    assert found.err.startswith(f"nothing to draw of {reference}: {said}")
    assert json.loads(found.out)["plot"] is None


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--set", "limit=1 N m"], "--set says at which values curves are drawn; add --plot."),
        (["--plot", "--set", "limits=1 N m"], "--set limits: controller/pid has no such parameter. Did you mean"),
        (["--plot", "--set", "limit=1 kg"], "--set limit=1 kg: limit: kg is a unit of mass"),
    ],
)
def test_a_wrong_setting_is_told(words: list[str], said: str, capsys: pytest.CaptureFixture[str]) -> None:
    found = gaitsim(capsys, "library", "show", "controller/pid", *words)
    assert found.code == 2
    assert found.err.startswith(said)


def test_a_folder_that_is_a_file_is_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "file").write_text("")
    said = gaitsim(capsys, "library", "show", "controller/pid", "--plot", "--folder", str(tmp_path / "file"))
    assert said.code == 3
    assert said.err.strip().endswith("choose another --folder.")
