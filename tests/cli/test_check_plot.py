"""gaitsim check --plot: a picture of moment arms, and a warning where one changes its sign."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from gaitsim.cli.main import main

LEG = Path(__file__).resolve().parents[2] / "specs" / "hopping_leg_mass.yaml"
SLIPPING = "extensor.path.side=[{on: thigh.distal, at: [7 cm, 0 m, 0 m]}]"


def check(*words: str, spec: Path = LEG) -> int:
    with pytest.raises(SystemExit) as ended:
        main(["check", str(spec), *words])
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
    assert "extensor extends knee (the child turns forwards)" in said.out


def test_a_change_of_sign_is_a_warning(capsys: pytest.CaptureFixture[str]) -> None:
    assert check("--set", SLIPPING, "--json") == 0
    said = capsys.readouterr()
    (warning,) = json.loads(said.out)["warnings"]
    assert "extensor.path: the moment arm over knee changes sign at 119 deg (range: 30 to 140 deg)" in warning
    assert warning.endswith("wrap it around the joint, move its points or its side.")
    assert said.err.startswith("warning: ")


def test_without_warnings_nothing_is_said(capsys: pytest.CaptureFixture[str]) -> None:
    assert check("--json") == 0
    said = capsys.readouterr()
    assert json.loads(said.out)["warnings"] == []
    assert said.err == ""


# What Geyer & Herr's muscles do, and with which arm in m where the joint counts extension positive.
TURNS = {
    ("soleus", "ankle"): "plantarflexes",
    ("tibialis_anterior", "ankle"): "dorsiflexes",
    ("gastrocnemius", "ankle"): "plantarflexes",
    ("gastrocnemius", "knee"): "flexes",
    ("vastus", "knee"): "extends",
    ("hamstrings", "hip"): "extends",
    ("hamstrings", "knee"): "flexes",
    ("gluteus", "hip"): "extends",
    ("hip_flexor", "hip"): "flexes",
}


def test_paths_with_moment_arms_are_drawn_and_told_in_words(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    spec = LEG.with_name("walking_geyer2010.yaml")
    assert check("--plot", "--json", "--folder", str(tmp_path), spec=spec) == 0
    told = json.loads(capsys.readouterr().out)
    assert Path(told["plot"]).read_bytes()[:4] == b"\x89PNG"
    arms = {(arm["muscle"], arm["joint"]): arm for arm in told["moment_arms"]}
    assert set(arms) == {(f"leg_{s}.{muscle}", f"leg_{s}.{joint}") for s in "lr" for muscle, joint in TURNS}
    for (muscle, joint), arm in arms.items():
        does = TURNS[muscle.partition(".")[2], joint.partition(".")[2]]
        assert arm["says"].startswith(f"{muscle} {does} {joint} (the child turns ")
        assert (arm["arm"] > 0) == (does in ("extends", "plantarflexes"))
    assert arms["leg_l.gluteus", "leg_l.hip"]["arm"] == pytest.approx(0.1)


@pytest.mark.parametrize(("arm", "does"), [("4 cm", "flexes"), ("-4 cm", "extends")])
def test_an_extensor_that_pulls_the_wrong_way_is_seen(
    arm: str, does: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = f"{{use: path/constant_arm, moment_arm: {arm}, reference_angle: 40 deg, angle: {{from: knee.angle}}, "
    path += "angular_velocity: {from: knee.velocity}, to: {moment: knee.torque}}"
    assert check("--plot", "--folder", str(tmp_path), "--set", f"extensor.path={path}") == 0
    assert f"extensor {does} knee (the child turns " in capsys.readouterr().out


def test_a_massless_leg_has_nothing_to_draw(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert check("--plot", "--folder", str(tmp_path), spec=LEG.with_name("hopping_geyer2003.yaml")) == 0
    assert capsys.readouterr().err == "nothing to draw: no path crosses a hinge\n"
