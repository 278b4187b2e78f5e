"""gaitsim library used-by, test and history: who uses which version of a component, and what a change does to them."""

from __future__ import annotations

import json
import shutil
import subprocess
from pathlib import Path
from typing import Any

import pytest

from gaitsim.components.find import Library
from gaitsim.distribution import shipped_folder, shipped_specs

from .commands import gaitsim

MUSCLE = Path("components/muscle/geyer2003.py")
CURVE = "return math.exp(math.log(0.05) * abs((length - 1) / width) ** 3)"


def changed() -> None:
    """The muscle's force-length curve by 1 % higher."""
    text = MUSCLE.read_text(encoding="utf-8")
    assert CURVE in text
    MUSCLE.write_text(text.replace(CURVE, CURVE.replace("return ", "return 1.01 * ")), encoding="utf-8")


@pytest.fixture
def result(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> str:
    """A folder with a recorded spec, its muscle, and a result; the result."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("GAITSIM_RESULTS", raising=False)
    text = shipped_specs()["hopping_geyer2003"].read_text(encoding="utf-8")
    Path("hopper.yaml").write_text(text.replace("duration: 20 s", "duration: 2 s"), encoding="utf-8")
    MUSCLE.parent.mkdir(parents=True)
    shutil.copy(shipped_folder() / "muscle" / "geyer2003.py", MUSCLE)
    gaitsim(capsys, "archive", "record", "hopper.yaml")
    return str(json.loads(gaitsim(capsys, "run", "hopper.yaml", "--json").out)["result"])


def asked(capsys: pytest.CaptureFixture[str], *words: str, code: int = 0) -> dict[str, Any]:
    said = gaitsim(capsys, "library", *words, "--json")
    assert said.code == code, said.err
    found: dict[str, Any] = json.loads(said.out)
    return found


def test_an_old_result_reproduces_and_a_changed_component_is_told_of_all_its_users(
    result: str, capsys: pytest.CaptureFixture[str]
) -> None:
    users = ("muscle/geyer2003", "hopper.yaml")
    before = asked(capsys, "used-by", *users)
    assert [(user["what"], user["name"]) for user in before["users"]] == [("spec", "hopper.yaml"), ("result", result)]
    assert {user["version"] for user in before["users"]} == {before["version"]}
    tested = asked(capsys, "test", *users)
    assert [(user["name"], user["state"]) for user in tested["users"]] == [("hopper.yaml", "holds"), (result, "same")]
    changed()
    verified = gaitsim(capsys, "results", "verify", result)
    assert (verified.code, verified.out) == (0, f"{result}: 1 of 1 runs reproduced bit for bit\n")
    after = asked(capsys, "used-by", *users)
    assert [user["version"] for user in after["users"]] == [after["version"], before["version"]]
    tested = asked(capsys, "test", *users, code=4)
    assert [(user["what"], user["name"], user["made_with"], user["state"]) for user in tested["users"]] == [
        ("spec", "hopper.yaml", before["version"], "differs"),
        ("result", result, before["version"], "differs"),
    ]
    apexes = [d for user in tested["users"] for d in user["differs"] if d["metric"] == "apex_height"]
    assert len(apexes) == 2 and apexes[0]["now"] == apexes[1]["now"] != apexes[0]["recorded"]
    told = gaitsim(capsys, "library", "test", *users)
    assert told.code == 4
    assert told.out.endswith("0 of 2 users of muscle/geyer2003 do what was recorded\n")


def test_a_search_is_tested_at_its_best_candidate(result: str, capsys: pytest.CaptureFixture[str]) -> None:
    brief = ("--smoke", "--workers", "0", "--results", "searches", "--json")
    searched = json.loads(gaitsim(capsys, "optimize", "hopper.yaml", *brief).out)["result"]
    changed()
    here = ("hopper.yaml", "--results", "searches")
    (found,) = (u for u in asked(capsys, "test", "muscle/geyer2003", *here, code=4)["users"] if u["what"] == "result")
    assert (found["name"], found["state"]) == (searched, "differs")
    assert "score" in {each["metric"] for each in found["differs"]}


def test_a_new_text_with_the_same_numbers_is_accepted(result: str, capsys: pytest.CaptureFixture[str]) -> None:
    MUSCLE.write_text(MUSCLE.read_text(encoding="utf-8") + "\n# Read twice.\n", encoding="utf-8")
    tested = asked(capsys, "test", "muscle/geyer2003", "hopper.yaml")
    assert [user["state"] for user in tested["users"]] == ["holds", "holds"]


def test_a_user_that_cannot_run_costs_only_itself(result: str, capsys: pytest.CaptureFixture[str]) -> None:
    Path("wrong.yaml").write_text("gaitsim: 1\nextends: hopper.yaml\nsimulate: {step: 1 kg}\n", encoding="utf-8")
    manifest = Path(result) / "manifest.json"
    shutil.copytree(result, "results/damaged")
    Path("results/damaged/manifest.json").write_text("{", encoding="utf-8")
    assert manifest.is_file()
    said = gaitsim(capsys, "library", "used-by", "muscle/geyer2003", ".")
    assert said.code == 0
    assert said.out.endswith("used by 2\n")
    assert "wrong.yaml:3:18: simulate.step: kg is a unit of mass" in said.err
    assert "results/damaged/manifest.json: this manifest cannot be read" in said.err


def test_the_versions_of_a_component(result: str, capsys: pytest.CaptureFixture[str]) -> None:
    git = ["git", "-c", "user.name=Alice", "-c", "user.email=alice@example.org"]
    for words in (["init", "-q"], ["add", "components"], ["commit", "-qm", "The muscle"]):
        subprocess.run([*git, *words], check=True)
    first = asked(capsys, "used-by", "muscle/geyer2003", "hopper.yaml")["version"]
    MUSCLE.write_text(MUSCLE.read_text(encoding="utf-8") + "\n# Read twice.\n", encoding="utf-8")
    for words in (["add", "components"], ["commit", "-qm", "Read twice"]):
        subprocess.run([*git, *words], check=True)
    second = asked(capsys, "used-by", "muscle/geyer2003", "hopper.yaml")["version"]
    changed()
    found = asked(capsys, "history", "muscle/geyer2003", "hopper.yaml")["versions"]
    assert [one["digest"] for one in found[:2]] == [first, second]
    assert [one["origin"].partition(" by ")[2] for one in found[:2]] == ["Alice: The muscle", "Alice: Read twice"]
    assert [one["origin"] for one in found[2:]] == ["as it stands now"]
    assert [one["present"] for one in found] == [False, False, True]
    assert [one["users"] for one in found] == [[result], [], ["hopper.yaml"]]
    shutil.rmtree(".git")
    found = asked(capsys, "history", "muscle/geyer2003", "hopper.yaml")["versions"]
    assert [(one["digest"], one["origin"]) for one in found] == [
        (first, f"result {result}"),
        (found[1]["digest"], "as it stands now"),
    ]


@pytest.mark.parametrize("command", ["used-by", "test", "history"])
def test_an_unknown_component_is_told(
    command: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    said = gaitsim(capsys, "library", command, "muscle/geier2003")
    assert (said.code, said.err) == (
        2,
        "there is no component muscle/geier2003. Did you mean muscle/geyer2003?\n",
    )


def test_a_version_is_the_digest_of_the_loaded_component() -> None:
    library = Library((shipped_folder(),))
    for reference in ("muscle/geyer2003", "muscle/geyer2010", "segment/thigh"):
        assert library.version(reference) == library.find(reference).digest
    assert library.version("norms/fukuchi2018_walking") and library.version("muscle/none") is None
