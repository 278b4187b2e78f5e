"""--json: one document on stdout whatever happens, and talk on stderr."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from gaitsim.cli.main import main

SPEC = """\
gaitsim: 1
parts:
  pendulum: {use: segment/rod, mass: 2 kg, length: 1 m}
  pivot: {use: joint/hinge, parent: world, child: pendulum.proximal}
  brake: {use: controller/brake, angle: {from: pivot.angle}, to: pivot.torque}
initial: {pivot.angle: 30 deg}
simulate: {duration: 0.1 s, step: 1 ms}
"""
BRAKE = '''\
from gaitsim.component import Component, Input, Output, Parameter


class Brake(Component):
    """Breaks."""

    limit = Parameter("rad", "Below this angle it breaks.", default=0.5)
    angle = Input("rad", "An angle.")
    torque = Output("N m", "Nothing.")

    @staticmethod
    def output(p, u, x, y):
        y.torque = 0.0
        if u.angle < p.limit:
            raise ValueError("it broke")
'''
BROKE = "brake (controller/brake) raised in output at 0.08 s (components/controller/brake.py:15): ValueError: it broke"


@pytest.fixture(autouse=True)
def study(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "components/controller").mkdir(parents=True)
    (tmp_path / "components/controller/brake.py").write_text(BRAKE)
    (tmp_path / "spec.yaml").write_text(SPEC)
    return tmp_path


def ran(capsys: pytest.CaptureFixture[str], *words: str) -> tuple[Any, Any, str]:
    """The exit code, the document on stdout and the talk."""
    with pytest.raises(SystemExit) as ended:
        main(list(words))
    out, err = capsys.readouterr()
    return ended.value.code, json.loads(out), err


@pytest.mark.parametrize("command", ["check", "show", "run"])
def test_an_invalid_spec(command: str, study: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (study / "spec.yaml").write_text(SPEC.replace("2 kg", "2 m").replace("pivot.torque", "pivot.torqu"))
    code, data, err = ran(capsys, command, "spec.yaml", "--json")
    mass = 'm is a unit of length; this needs a mass, such as "80 kg".'
    port = "there is no input pivot.torqu. Did you mean pivot.torque?"
    assert code == 3
    assert data == {
        "status": "invalid",
        "errors": [
            {"file": "spec.yaml", "line": 3, "column": 38, "address": "pendulum.mass", "message": mass},
            {"file": "spec.yaml", "line": 5, "column": 66, "address": "brake.torque", "message": port},
        ],
    }
    assert err.count("\n      |") == 2
    assert "Traceback" not in err
    assert sorted(p.name for p in study.iterdir()) == ["components", "spec.yaml"]


@pytest.mark.parametrize("command", ["check", "show", "run"])
def test_a_missing_spec(command: str, capsys: pytest.CaptureFixture[str]) -> None:
    message = "there is no such file. Did you mean spec.yaml?"
    code, data, err = ran(capsys, command, "spce.yaml", "--json")
    fault = {"file": "spce.yaml", "line": None, "column": None, "address": None, "message": message}
    assert (code, data, err) == (3, {"status": "invalid", "errors": [fault]}, f"spce.yaml: {message}\n")


@pytest.mark.parametrize("mode", ["rapid", "normal"])
def test_a_failed_simulation(mode: str, capsys: pytest.CaptureFixture[str]) -> None:
    code, data, err = ran(capsys, "run", "spec.yaml", "--no-save", "--json", "--mode", mode)
    assert (code, data["status"], data["reason"], data["metrics"]) == (4, "failed", BROKE, {})
    assert [fault["message"] for fault in data["errors"]] == [BROKE]
    assert err == f"failed: {BROKE}\n"


def test_a_study_of_which_some_rows_fail(capsys: pytest.CaptureFixture[str]) -> None:
    words = ["run", "spec.yaml", "--no-save", "--vary", "brake.limit=0.5 rad,-9 rad"]
    code, data, err = ran(capsys, *words, "--json")
    assert code == 0
    assert [row["status"] for row in data["rows"]] == ["failed", "completed"]
    assert err == f"brake.limit = 0.5 rad: failed: {BROKE}\n"


def test_a_usage_error_of_ours(capsys: pytest.CaptureFixture[str]) -> None:
    code, data, err = ran(capsys, "check", "spec.yaml", "--set", "brake.limit", "--json")
    message = "--set brake.limit: a setting is address=value; write, for example, --set leg.knee.damping=5."
    assert (code, data["status"], data["errors"][0]["message"], err) == (2, "usage", message, f"{message}\n")


@pytest.mark.parametrize("words", [["chek", "a.yaml"], ["check"], ["check", "a", "--x"], ["run", "a", "--mode", "x"]])
def test_what_the_command_line_refuses(words: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main(words)
    out, err = capsys.readouterr()
    assert (ended.value.code, out) == (2, "")
    assert err.startswith("gaitsim: ")
    assert err.endswith("--help'.\n")
