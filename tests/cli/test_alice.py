"""Alice's story, through the command line only: Bob's result, a prototype of hers, a search, into the library."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from .commands import gaitsim

BRIEF = "simulate: {duration: 2 s}\n"
PROTOTYPE = """\
gaitsim: 1
about: Bob's hopper with a reflex that has a threshold.
extends: bob.yaml
parts:
  feedback:
    use: controller/my_reflex
    threshold: {value: 0.02, tune: [0, 0.1]}
"""
PHYSICS = '''
"""controller/my_reflex: silent below its threshold, proportional to the signal above it."""

from pathlib import Path

from gaitsim.components.find import Library
from gaitsim.distribution import shipped_folder
from gaitsim.simulation.trial import Trial

LIBRARY = Library((Path(__file__).parents[1] / "components", shipped_folder()))


def test_it_grows_with_the_signal_above_its_threshold() -> None:
    numbers = {"gain": 4, "threshold": 0.02, "bias": 0.01, "signal": 0.52, "gate": 1}
    made = Trial(LIBRARY.find("controller/my_reflex")).put(numbers)
    assert not made.call("output", "normal")
    assert abs(made.y.stimulation - 2.01) < 1e-12
'''


@pytest.mark.slow
def test_alices_story(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("GAITSIM_STATE", str(tmp_path / "state"))

    def does(*words: str) -> str:
        said = gaitsim(capsys, *words)
        assert said.code == 0, f"{words}: {said.err}"
        return said.out

    def told(*words: str) -> dict[str, Any]:
        return dict(json.loads(does(*words, "--json")))

    # Bob tunes a model in his project, and keeps a run of it.
    does("new", "project", "bob", "--from", "hopping_leg_mass")
    with Path("projects/bob/bob.yaml").open("a", encoding="utf-8") as file:
        file.write(BRIEF)
    bobs = told("run", "projects/bob/bob.yaml")
    does("results", "note", bobs["result"], "tuned for height")

    # Alice finds it, and begins where he ended.
    found = told("results", "list", "--noted", "height")["results"]
    assert [row["result"] for row in found] == [bobs["result"]]
    does("new", "project", "alice", "--from", bobs["result"])
    assert told("run", "projects/alice/alice.yaml")["metrics"] == bobs["metrics"]

    # She replaces the controller by a prototype of hers: nothing else differs.
    does("library", "new", "controller", "my_reflex", "--folder", "projects/alice")
    Path("projects/alice/alice.yaml").write_text(PROTOTYPE, encoding="utf-8")
    changes = told("results", "compare", bobs["result"], "projects/alice/alice.yaml", "--no-figures")["changes"]
    assert [(c["what"], c["where"], c["first"], c["second"]) for c in changes] == [
        ("component", "feedback", "controller/muscle_feedback", "controller/my_reflex"),
        ("value", "feedback.offset", "0.0", ""),
        ("value", "feedback.threshold", "", "0.02"),
    ]

    # A search of two generations from Bob's values, and how it compares.
    words = ("--generations", "2", "--population", "4", "--from", "tuned", "--workers", "0")
    alices = told("optimize", "projects/alice/alice.yaml", *words)["result"]
    compared = told("results", "compare", bobs["result"], alices)
    assert {c["where"].partition(".")[0] for c in compared["changes"] if c["what"] != "tuned value"} == {"feedback"}
    hop = next(row for row in compared["metrics"] if row["name"] == "hop")
    assert hop["first"] == bobs["metrics"]["hop"]
    assert hop["second"] > 0.1
    assert all(Path(path).is_file() for path in compared["figures"])
    assert len(compared["figures"]) == 4

    # A colleague elsewhere is told what it brings, reads it, and verifies it.
    does("results", "export", alices, "--out", "alice.zip")
    monkeypatch.setenv("GAITSIM_STATE", str(tmp_path / "colleague"))
    brought = told("results", "import", "alice.zip", "--results", "received")
    assert [row["file"] for row in brought["components"] if not row["same"]] == ["components/controller/my_reflex.py"]
    assert [row["file"] for row in brought["components"] if not row["known"]] == ["components/controller/my_reflex.py"]
    assert gaitsim(capsys, "results", "verify", brought["result"]).code == 3
    assert told("results", "verify", brought["result"], "--trust")["status"] == "reproduced"

    # It is validated: her component moves into the library of the lab, and every project finds it there.
    monkeypatch.setenv("GAITSIM_STATE", str(tmp_path / "state"))
    Path("projects/alice/tests/test_my_reflex.py").write_text(PHYSICS, encoding="utf-8")
    does("library", "promote", "controller/my_reflex", "--from", "projects/alice")
    for spec in ("alice", "bob"):
        if spec == "bob":
            text = Path("projects/bob/bob.yaml").read_text(encoding="utf-8")
            Path("projects/bob/bob.yaml").write_text(f"{text}parts: {{feedback: {{use: controller/my_reflex}}}}\n")
        tree = told("show", f"projects/{spec}/{spec}.yaml")["tree"]
        assert next(row["library"] for row in tree if row["address"] == "feedback") == "lab"

    users = gaitsim(capsys, "library", "used-by", "controller/my_reflex", "--json")
    assert {row["name"] for row in json.loads(users.out)["users"]} >= {"projects/alice/alice.yaml", alices}
    assert "project.yaml" not in users.err

    # Old results can be revisited for ever.
    for result in (bobs["result"], alices):
        assert told("results", "verify", result)["status"] == "reproduced"
