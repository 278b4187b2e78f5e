"""A damaged result is not continued: the error names the damage, and nothing is lost."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from .files import SMALL, content, lines, rewritten


def damage_manifest(folder: Path) -> None:
    (folder / "manifest.json").write_text('{"kind": ')


def damage_search(folder: Path) -> None:
    data = json.loads((folder / "manifest.json").read_text())
    (folder / "manifest.json").write_text(json.dumps(data | {"search": {"seed": "x"}}))


def other_seed(folder: Path) -> None:
    data = json.loads((folder / "manifest.json").read_text())
    data["search"]["seed"] = 5
    (folder / "manifest.json").write_text(json.dumps(data))


DAMAGES: dict[str, tuple[Any, str]] = {
    "no manifest": (lambda f: (f / "manifest.json").unlink(), "there is no manifest.json, so this is not a result"),
    "manifest garbage": (damage_manifest, "manifest.json: this manifest cannot be read"),
    "manifest is a list": (lambda f: (f / "manifest.json").write_text("[]"), "json: this is [] and no mapping"),
    "search garbage": (damage_search, "what it says about its search cannot be read"),
    "other seed": (other_seed, "generation 1, candidate 0 is not the vector that this search asks for"),
    "no journal": (lambda f: (f / "evaluations.jsonl").unlink(), "evaluations.jsonl: this journal is missing"),
    "no spec": (lambda f: (f / "spec.yaml").unlink(), "spec.yaml: there is no such file; restore it from a copy"),
    "spec edited": (lambda f: rewritten(f / "spec.yaml", ("60", "61")), "spec.yaml was edited after it was made"),
    "component edited": (
        lambda f: rewritten(f / "components/trap/none.py", ("1.0", "2.0")),
        "components/trap/none.py was edited after it was made",
    ),
    "component gone": (lambda f: (f / "components/trap/none.py").unlink(), "none.py was removed after it was made"),
    "component added": (lambda f: (f / "components/trap/x.py").write_text("1"), "components/trap/x.py was added after"),
    "component binary": (
        lambda f: (f / "components/trap/none.py").write_bytes(b"\xff\xfe"),
        "components/trap/none.py: byte 0 (0xff, in line 1) is not UTF-8; restore it from a copy",
    ),
}


@pytest.mark.parametrize("name", DAMAGES)
@pytest.mark.parametrize("how", ["folder", "spec"])
def test_a_damaged_result_is_not_continued(begun: Path, command: Any, name: str, how: str) -> None:
    damage, said = DAMAGES[name]
    damage(begun)
    before = content(begun)
    words = [str(begun), "--generations", "3", "--workers", "0"] if how == "folder" else ["spec.yaml", *SMALL]
    ended = command("optimize", *words, "--resume")
    assert ended.code == 3, ended.err
    nameless = how == "spec" and name in ("no manifest", "manifest garbage", "manifest is a list")
    assert ("there is no search of spec.yaml to resume" if nameless else said) in ended.err
    assert lines(content(begun)) == lines(before)
    shows = command("results", "list", "--json")
    assert shows.code == 0
    assert len(shows.data["results"]) == (0 if name == "no manifest" else 1)
