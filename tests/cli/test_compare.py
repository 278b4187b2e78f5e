"""gaitsim results compare: two models, then their runs."""

from __future__ import annotations

import json
import shutil
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from gaitsim.distribution import shipped_specs
from gaitsim.study.comparison import gait_pairs
from tests.analysis.replays import cut
from tests.analysis.walking import bent, walk

from .commands import gaitsim

Capture = pytest.CaptureFixture[str]


@pytest.fixture(autouse=True)
def _folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("GAITSIM_STATE", str(tmp_path / "state"))
    shutil.copy(shipped_specs()["hopping_geyer2003"], "hop.yaml")
    Path("strong.yaml").write_text(
        "gaitsim: 1\nextends: hop.yaml\nparts: {feedback: {gain: {value: 3, tune: [1, 15], source: geyer2003}}}\n"
    )


def ran(capsys: Capture, spec: str) -> str:
    said = gaitsim(capsys, "run", spec, "--set", "simulate.duration=2.5 s", "--json")
    return str(json.loads(said.out)["result"])


def compared(capsys: Capture, *words: str) -> dict[str, Any]:
    said = gaitsim(capsys, "results", "compare", *words, "--json")
    assert said.code == 0, said.err
    return dict(json.loads(said.out))


def test_two_results_that_differ_in_one_value(capsys: Capture) -> None:
    one, other = ran(capsys, "hop.yaml"), ran(capsys, "strong.yaml")
    found = compared(capsys, one, other)
    assert found["changes"] == [{"what": "tuned value", "where": "feedback.gain", "first": "2.64", "second": "3.0"}]
    recorded = [
        json.loads(line)["metrics"]["apex_height"]
        for folder in (one, other)
        for line in Path(folder, "evaluations.jsonl").read_text().splitlines()
    ]
    apex = next(row for row in found["metrics"] if row["name"] == "apex_height")
    assert [apex["first"], apex["second"]] == recorded
    assert apex["difference"] == recorded[1] - recorded[0]
    assert apex["percent"] == pytest.approx(100 * (recorded[1] / recorded[0] - 1))
    assert found["gait"] == []
    folder = Path(other) / f"comparison-with-{Path(one).name}" / "figures"
    assert sorted(path.name for path in folder.iterdir()) == ["control.png", "ground.png", "motion.png", "muscles.png"]
    assert sorted(found["figures"]) == sorted(str(path) for path in folder.iterdir())
    assert gaitsim(capsys, "results", "verify", other).code == 0
    table = gaitsim(capsys, "results", "compare", one, other, "--no-figures").out
    assert any(line.split() == ["tuned", "value", "feedback.gain", "2.64", "3"] for line in table.splitlines())
    assert "tuned values: 1\n" in table


def test_a_spec_and_its_result_are_the_same(capsys: Capture) -> None:
    result = ran(capsys, "hop.yaml")
    said = gaitsim(capsys, "results", "compare", result, result, "--no-figures")
    assert said.out.startswith("the models are the same, value by value, and so is the code of their components\n")
    # The run was of 2.5 s, by --set.
    found = compared(capsys, "hop.yaml", result, "--no-figures")
    assert [(change["what"], change["where"]) for change in found["changes"]] == [("simulation", "duration")]
    assert found["figures"] == []


def test_code_that_was_edited_is_named(capsys: Capture) -> None:
    one = ran(capsys, "hop.yaml")
    own = Path("components/muscle/geyer2003.py")
    own.parent.mkdir(parents=True)
    shipped = shipped_specs()["hopping_geyer2003"].parents[1] / "library" / "muscle" / "geyer2003.py"
    own.write_text(shipped.read_text(encoding="utf-8") + "\n# a line more\n", encoding="utf-8")
    (change,) = compared(capsys, one, "hop.yaml", "--no-figures", "--folder", "x")["changes"][:1]
    assert (change["what"], change["where"]) == ("code", "muscle/geyer2003.py")
    assert change["second"].endswith("(+2 -0 lines)")


def test_the_gaits_of_two_walkers() -> None:
    pairs = {pair.name: pair for pair in gait_pairs([bent("bob", 40), bent("alice", 60)])}
    knee = pairs["knee_flexion_highest"]
    assert (knee.unit, knee.difference, knee.percent) == ("deg", pytest.approx(20, abs=0.1), pytest.approx(50, abs=0.3))
    assert pairs["step_length"].difference == 0
    assert gait_pairs([bent("bob", 40), replace(cut(walk({}), 400), label="fallen")]) == []


def test_what_cannot_be_compared_is_told(capsys: Capture) -> None:
    result = ran(capsys, "hop.yaml")
    assert gaitsim(capsys, "results", "compare", result, "results/nosuch").code == 3
    with (Path(result) / "spec.yaml").open("a") as file:
        file.write("# edited\n")
    said = gaitsim(capsys, "results", "compare", result, "hop.yaml")
    assert said.code == 3
    assert said.err.startswith(f"{result}: spec.yaml was edited after it was made")
