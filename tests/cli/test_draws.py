"""gaitsim run --draws, on a stone whose fall is known for every height."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from gaitsim.results.rows import read_rows

from .commands import gaitsim

# After n steps of semi-implicit Euler the stone has fallen by g dt^2 n (n + 1) / 2.
STONE = """
gaitsim: 1
parts:
  stone: {use: segment/point_mass, mass: {value: 1 kg, tune: [0.5 kg, 5 kg]}}
  guide: {use: joint/vertical, parent: world, child: stone.center}
initial: {guide.position: {value: 122 cm, tune: [0 m, 1.225 m]}}
measures:
  landed: {use: measure/fall, height: {from: guide.position}, below: 0 m}
  way: {use: measure/range, signal: {from: guide.position}}
objective: {use: objective/minimize, value: {from: way}}
simulate: {duration: 0.5 s, step: 1 ms}
"""
HEIGHT, MASS = "initial.guide.position", "stone.mass"
ALL = ("--draws", "12", "--within", "1 %", "--seed", "1")


@pytest.fixture
def spec(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    monkeypatch.chdir(tmp_path)
    Path("stone.yaml").write_text(STONE, encoding="utf-8")
    return "stone.yaml"


def drawn(capsys: pytest.CaptureFixture[str], *words: str) -> dict[str, Any]:
    said = gaitsim(capsys, "run", *words, "--json")
    assert said.code == 0, said.err
    return dict(json.loads(said.out))


def without_wall(rows: list[dict[str, Any]]) -> list[dict[str, Any]]:
    return [{name: value for name, value in row.items() if name != "wall_seconds"} for row in rows]


def lands(height: float) -> bool:
    """Below 0 after 498 steps is told in the 499th and ends the run in the 500th, its last."""
    return height < 9.81e-6 * 498 * 499 / 2


def test_each_draw_falls_as_its_height_says(spec: str, capsys: pytest.CaptureFixture[str]) -> None:
    found = drawn(capsys, spec, *ALL)
    heights = [row["values"][HEIGHT] for row in found["rows"]]
    assert [row["draw"] for row in found["rows"]] == list(range(1, 13))
    assert [row["status"] == "stopped" for row in found["rows"]] == [lands(height) for height in heights]
    assert 0 < found["completed"] < 12
    assert found["completed"] == sum(not lands(height) for height in heights)
    assert found["draws"] == {"count": 12, "within": 0.01, "seed": 1}
    assert all(1.2078 <= height <= 1.225 for height in heights) and heights.count(1.225) > 0
    assert all(0.99 <= row["values"][MASS] <= 1.01 for row in found["rows"])


def test_the_same_seed_draws_the_same_whatever_their_number(spec: str, capsys: pytest.CaptureFixture[str]) -> None:
    few = drawn(capsys, spec, "--draws", "3", "--no-save")
    many = drawn(capsys, spec, *ALL, "--no-save")
    assert without_wall(many["rows"])[:3] == without_wall(few["rows"])
    other = drawn(capsys, spec, "--draws", "3", "--seed", "2", "--no-save")
    assert all(a["values"] != b["values"] for a, b in zip(few["rows"], other["rows"], strict=True))


def test_no_width_is_the_plain_run_again_and_again(spec: str, capsys: pytest.CaptureFixture[str]) -> None:
    plain = drawn(capsys, spec, "--no-save")
    found = drawn(capsys, spec, "--draws", "2", "--within", "0 %", "--no-save")
    for row in found["rows"]:
        assert row["values"] == {MASS: 1, HEIGHT: 1.22}
        assert all(row[name] == plain[name] for name in ("status", "score", "metrics", "steps"))


def test_the_summary_is_of_the_rows(spec: str, capsys: pytest.CaptureFixture[str]) -> None:
    found = drawn(capsys, spec, *ALL, "--no-save")
    ways = [row["metrics"]["way"] for row in found["rows"]]
    said = found["summary"]["way"]
    assert (said["least"], said["greatest"], said["unit"], said["draws"]) == (min(ways), max(ways), "m", 12)
    assert said["mean"] == pytest.approx(sum(ways) / 12, rel=1e-14)
    assert found["summary"]["score"]["mean"] == pytest.approx(said["mean"], rel=1e-14)
    assert list(found["summary"]) == [*found["rows"][0]["metrics"], "score"]


def test_the_table_and_how_many_completed(spec: str, capsys: pytest.CaptureFixture[str]) -> None:
    said = gaitsim(capsys, "run", spec, *ALL)
    lines = [" ".join(line.split()) for line in said.out.splitlines()]
    found = drawn(capsys, spec, *ALL, "--no-save")
    assert lines[0] == "metric mean least greatest unit"
    way = found["summary"]["way"]
    assert f"way {way['mean']:.5g} {way['least']:.5g} {way['greatest']:.5g} m" in lines
    done = found["completed"]
    assert lines[-1] == f"{done} of 12 completed: all 2 tuned values changed by up to 1 %, seed 1"
    fallen = [row for row in found["rows"] if row["status"] == "stopped"]
    told = [f"draw {row['draw']}: stopped by landed at {row['simulated_seconds']:.4g} s" for row in fallen]
    assert said.err.splitlines()[1:] == told and said.err.startswith("saved in results/")


def test_draws_go_round_the_tuned_values(spec: str, capsys: pytest.CaptureFixture[str]) -> None:
    Path("stone.tuned.yaml").write_text("result: results/a\nvalues: {stone.mass: 3 kg}\n", encoding="utf-8")
    tuned = drawn(capsys, spec, *ALL, "--no-save")["rows"]
    assert all(2.97 <= row["values"][MASS] <= 3.03 for row in tuned)
    plain = drawn(capsys, spec, *ALL, "--start", "--no-save")["rows"]
    for one, three in zip(plain, tuned, strict=True):
        assert three["values"][MASS] == pytest.approx(3 * one["values"][MASS], rel=1e-14)
    fixed = drawn(capsys, spec, *ALL, "--set", f"{MASS}=2 kg", "--no-save")["rows"]
    assert all(list(row["values"]) == [HEIGHT] for row in fixed)


def test_a_result_keeps_every_draw_and_runs_it_again(spec: str, capsys: pytest.CaptureFixture[str]) -> None:
    found = drawn(capsys, spec, *ALL)
    folder = found["result"]
    kept = read_rows(Path(folder))
    assert [row["values"] for row in kept] == [row["values"] for row in found["rows"]]
    assert json.loads((Path(folder) / "manifest.json").read_text())["draws"] == found["draws"]
    readme = (Path(folder) / "README.md").read_text(encoding="utf-8")
    assert f"- {found['completed']} of 12 draws within 1 % completed (seed 1)\n- draw 1: " in readme
    verified = gaitsim(capsys, "results", "verify", folder)
    assert (verified.code, "12 of 12 runs reproduced bit for bit" in verified.out) == (0, True)
    seventh = gaitsim(capsys, "run", folder, "--candidate", "7", "--no-save", "--json")
    assert f"run 7 of 12 of {folder}: draw 7" in seventh.err
    assert json.loads(seventh.out)["metrics"] == found["rows"][6]["metrics"]
    around = drawn(capsys, folder, "--candidate", "7", "--draws", "2", "--within", "0 %", "--no-save")
    assert [row["values"] for row in around["rows"]] == [kept[6]["values"]] * 2
    again = drawn(capsys, folder, *ALL, "--no-save")
    assert without_wall(again["rows"]) == without_wall(found["rows"])


def test_draws_around_one_run_of_a_study(spec: str, capsys: pytest.CaptureFixture[str]) -> None:
    folder = drawn(capsys, spec, "--set", "study=[{stone.mass: 1 kg}, {simulate.duration: 0.3 s}]")["result"]
    second = drawn(capsys, folder, "--candidate", "2", "--no-save")
    assert second["metrics"] == read_rows(Path(folder))[1]["metrics"]
    found = drawn(capsys, folder, "--candidate", "2", "--draws", "2", "--within", "0 %", "--no-save")
    assert [row["metrics"] for row in found["rows"]] == [second["metrics"]] * 2
    assert list(found["rows"][0]["values"]) == [MASS, HEIGHT]


def test_plain_python_draws_the_same(spec: str, capsys: pytest.CaptureFixture[str]) -> None:
    rapid, normal = (
        drawn(capsys, spec, "--draws", "2", "--mode", mode, "--no-save")["rows"] for mode in ("rapid", "normal")
    )
    assert without_wall(rapid) == without_wall(normal)


def test_what_is_zero_stays_and_is_told(spec: str, capsys: pytest.CaptureFixture[str]) -> None:
    zero = f"{HEIGHT}={{value: 0 m, tune: [0 m, 1 m]}}"
    said = gaitsim(capsys, "run", spec, *ALL, "--set", zero, "--no-save")
    assert said.err.splitlines()[0] == f"these are 0, which no share of it changes: {HEIGHT}"


def test_in_a_process_of_its_own(spec: str) -> None:
    command = [str(Path(sys.executable).with_name("gaitsim")), "run", spec, *ALL, "--no-save"]
    first, second = (subprocess.run(command, capture_output=True, text=True, check=True).stdout for _ in range(2))
    assert first == second
    assert " of 12 completed: " in first


@pytest.mark.parametrize(
    ("words", "code", "message"),
    [
        (
            ("--within", "1 %"),
            2,
            "--within 1 %: this needs --draws; add a number, such as --draws 10, or leave it out.",
        ),
        (("--seed", "3"), 2, "--seed 3: this needs --draws; add a number, such as --draws 10, or leave it out."),
        (("--draws", "0"), 2, "--draws 0: the smallest value is 1."),
        (("--draws", "-3"), 2, "--draws -3: the smallest value is 1."),
        (("--draws", "3", "--seed", "-1"), 2, "--seed -1: the smallest value is 0."),
        (
            ("--draws", "3", "--within", "-1 %"),
            2,
            "--within -1 %: this is a share from 0 % to 100 %; write such as '1 %'.",
        ),
        (
            ("--draws", "3", "--within", "1 kg"),
            2,
            "--within 1 kg: this is a share from 0 % to 100 %; write such as '1 %'.",
        ),
        (
            ("--draws", "3", "--within", "little"),
            2,
            "--within little: this is a share from 0 % to 100 %; write such as '1 %'.",
        ),
        (
            ("--draws", "3", "--within", "120 %"),
            2,
            "--within 120 %: this is a share from 0 % to 100 %; write such as '1 %'.",
        ),
        (("--draws", "3", "--within", "2"), 2, "--within 2: without its sign this is 200 %; write '2 %'."),
        (
            ("--draws", "3", "--vary", f"{MASS}=1 kg,2 kg"),
            2,
            "--draws 3: --draws applies to one spec, and --vary makes several; take one at a time, "
            "such as --set stone.mass=VALUE.",
        ),
        (
            ("--draws", "3", "--set", "study=[{stone.mass: 1 kg}, {stone.mass: 2 kg}]"),
            2,
            "--draws 3: --draws applies to one spec, and stone.yaml is a study of 2 runs; take one of its result with "
            "--candidate, or --set study=null.",
        ),
        (
            ("--draws", "3", "--out", "a.csv"),
            2,
            "--out writes one trajectory; drop --draws, or write one draw of its result: --candidate NUMBER.",
        ),
        (
            ("--draws", "3", "--set", f"{MASS}=1 kg", "--set", f"{HEIGHT}=1 m"),
            3,
            "stone.yaml: nothing is tuned in this spec, so no draw differs; give a value bounds, "
            "such as gain: {value: 1, tune: [0, 5]}.",
        ),
    ],
)
def test_what_is_refused(
    spec: str, words: tuple[str, ...], code: int, message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    said = gaitsim(capsys, "run", spec, *words)
    assert (said.code, said.err, said.out) == (code, f"{message}\n", "")
    assert not Path("results").exists()
