"""gaitsim library check: every fault of every file at once, with file and line."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from .commands import gaitsim

GOOD = '''\
from gaitsim.component import Component, Input, Output, Parameter


class Spring(Component):
    """A torque that grows with an angle."""

    stiffness = Parameter("N m/rad", "Torque per angle.", default=10, bounds=(0, 1000), source="geyer2003")
    angle = Input("rad", "Measured angle.")
    torque = Output("N m", "Torque against the angle.")

    @staticmethod
    def output(p, u, x, y):
        y.torque = -p.stiffness * u.angle
'''
TEXT = 'text = "{} N m".format(u.angle)\n        '


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path / "components"


def written(folder: Path, text: str, reference: str = "controller/spring") -> None:
    path = folder / f"{reference}.py"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")


def test_a_good_component_is_valid(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    written(folder, GOOD)
    assert gaitsim(capsys, "library", "check", "controller/spring") == (0, "1 component: valid\n", "")
    assert gaitsim(capsys, "library", "check", "components/controller/spring.py").code == 0
    assert json.loads(gaitsim(capsys, "library", "check", "components", "--json").out) == {
        "status": "valid",
        "components": 1,
    }


@pytest.mark.parametrize(
    ("right", "wrong", "line", "said"),
    [
        ("u.angle", "u.angel", 13, "u.angel is not declared. Did you mean u.angle?"),
        ('Output("N m"', 'Output("N"', 13, "y.torque is declared in N (a force); this gives a moment or an energy"),
        (', source="geyer2003"', "", 7, 'stiffness has a default and no source; write source="a key'),
        ("geyer2003", "gyer2003", 7, "stiffness: the source gyer2003 is in no references.bib. Did you mean geyer2003?"),
        ("default=10", "default=2000", 7, "stiffness: default 2000 is outside its bounds (0, 1000)."),
        (", bounds=(0, 1000)", "", 7, "stiffness has no bounds; write between which values it makes sense."),
        ("Measured angle.", "", 8, "angle has no doc; say what it is."),
        ('"""A torque that grows with an angle."""', "pass", 4, "the component has no doc; write what it computes"),
        ('Input("rad"', 'Input("turns"', 8, 'angle: "turns" is not a unit; write one made of'),
        ("y.torque = ", f"{TEXT}y.torque = ", 13, "this cannot become native code; write it with numbers"),
    ],
)
def test_each_rule(
    folder: Path, capsys: pytest.CaptureFixture[str], right: str, wrong: str, line: int, said: str
) -> None:
    assert right in GOOD
    written(folder, GOOD.replace(right, wrong))
    found = gaitsim(capsys, "library", "check", "components")
    assert found.code == 3
    place, _, message = found.err.splitlines()[0].partition(": ")
    assert place.startswith(f"components/controller/spring.py:{line}:")
    assert message.startswith(said)


def test_all_faults_of_all_files_are_told_at_once(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    broken = GOOD.replace("u.angle", "u.angel").replace(', source="geyer2003"', "").replace("Measured angle.", "")
    written(folder, broken)
    written(folder, GOOD.replace('"N m", "Torque', '"N", "Torque'), "joint/other")
    written(folder, "this is no Python", "sensor/third")
    said = gaitsim(capsys, "library", "check", "components", "--json")
    assert said.code == 3
    places = [(fault["file"], fault["line"]) for fault in json.loads(said.out)["errors"]]
    assert places == [
        *(("components/controller/spring.py", line) for line in (7, 8, 13)),
        ("components/joint/other.py", 13),
        ("components/sensor/third.py", 1),
    ]


def test_a_kind_is_a_contract(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    written(folder, GOOD, "activation/spring")
    said = gaitsim(capsys, "library", "check", "components")
    assert said.code == 3
    assert "this lacks the input excitation [1], which every component of activation/ has" in said.err
    assert "this lacks the output activation [1]" in said.err


def test_a_composite_is_checked_with_what_it_uses(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / "leg").mkdir(parents=True)
    (folder / "leg" / "mine.yaml").write_text(
        "about: A leg.\nparameters:\n  length: {unit: m, default: 1 m, bounds: [0 m, 2 m]}\n"
        "parts:\n  thigh: {use: segment/thihg}\n",
        encoding="utf-8",
    )
    said = gaitsim(capsys, "library", "check", "leg/mine").err
    assert "components/leg/mine.yaml:3:3: length has no doc; say what it is." in said
    assert "length has a default and no source" in said
    unknown = "thigh: there is no component segment/thihg. Did you mean segment/thigh?"
    assert f"components/leg/mine.yaml:5:16: {unknown}" in said


@pytest.mark.parametrize(
    ("word", "code", "said"),
    [
        ("muscle/geyer2011", 3, "there is no component muscle/geyer2011. Did you mean muscle/geyer2010?"),
        ("empty", 2, "empty: there is no component in it; name a folder of kinds, such as components."),
    ],
)
def test_what_is_not_there(folder: Path, capsys: pytest.CaptureFixture[str], word: str, code: int, said: str) -> None:
    (folder.parent / "empty").mkdir()
    found = gaitsim(capsys, "library", "check", word)
    assert (found.code, found.err.strip()) == (code, said)
