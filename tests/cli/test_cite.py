"""gaitsim cite: BibTeX of exactly what a model uses."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from gaitsim.components.bibliography import entries, keys_of, read_bibliography
from gaitsim.distribution import shipped_folder
from gaitsim.optimization.algorithms import ALGORITHMS

from .commands import gaitsim

ROOT = Path(__file__).resolve().parents[2]
PENDULUM, LEG = ROOT / "specs" / "pendulum_pid.yaml", ROOT / "specs" / "hopping_leg_mass.yaml"
SPEC = """
gaitsim: 1
parts:
  pendulum: {use: segment/rod, mass: {value: 2 kg, source: SOURCE}, length: 1 m}
  pivot: {use: joint/hinge, parent: world, child: pendulum.proximal}
simulate: {duration: 1 s, step: 1 ms}
"""


def keys(text: str) -> list[str]:
    return re.findall(r"^@\w+\{([^,]+),", text, re.MULTILINE)


def written(folder: Path, source: str) -> str:
    path = folder / "spec.yaml"
    path.write_text(SPEC.replace("SOURCE", source), encoding="utf-8")
    return str(path)


def test_a_model_of_choices_cites_its_tools_only(capsys: pytest.CaptureFixture[str]) -> None:
    said = gaitsim(capsys, "cite", str(PENDULUM))
    assert said.code == 0
    assert keys(said.out) == ["gaitsim", "todorov2012"]


def test_sources_of_spec_values_component_defaults_masks_and_the_search(capsys: pytest.CaptureFixture[str]) -> None:
    said = gaitsim(capsys, "cite", str(LEG), "--json")
    found = {entry["key"]: entry["used_by"] for entry in json.loads(said.out)["entries"]}
    assert {"gaitsim", "geyer2003", "geyer2010", "hansen2001", "todorov2012", "winter2009"} <= set(found)
    assert "extensor.max_isometric_force" in found["geyer2003"]  # the spec's own source:
    assert "extensor.width" in found["geyer2010"]  # a default of the component
    assert "muscle/geyer2010" in found["geyer2010"]  # the component itself
    assert "trunk.segment_mass" in found["winter2009"]  # a mask's expression
    assert "thigh.segment_mass" in found["winter2009"]
    assert found["hansen2001"] == ["optimize"]


def test_what_the_spec_no_longer_takes_from_a_source_is_not_cited(capsys: pytest.CaptureFixture[str]) -> None:
    own = gaitsim(capsys, "cite", str(LEG), "--set", "extensor.width=0.5", "--json")
    used = {entry["key"]: entry["used_by"] for entry in json.loads(own.out)["entries"]}
    assert "extensor.width" not in used["geyer2010"]
    swapped = gaitsim(capsys, "cite", str(LEG), "--set", "extensor.use=muscle/geyer2003")
    assert "geyer2003" in keys(swapped.out)
    assert "extensor.width" not in str(json.loads(own.out)["words"])


def test_a_result_is_cited_with_the_search_that_tuned_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    made = gaitsim(capsys, "optimize", str(PENDULUM), "--smoke", "--workers", "0", "--json")
    said = gaitsim(capsys, "cite", json.loads(made.out)["result"])
    assert said.code == 0
    assert keys(said.out) == ["gaitsim", "hansen2001", "hansen2019", "todorov2012"]


def test_a_source_in_words_is_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    said = gaitsim(capsys, "cite", written(tmp_path, "measured in our laboratory"))
    assert said.code == 0
    assert said.err == "in words, to be cited by hand: measured in our laboratory (pendulum.mass)\n"


def test_a_definition_and_a_key_with_a_place_in_it_are_as_they_should_be(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert gaitsim(capsys, "cite", written(tmp_path, '"definition: some"')).err == ""
    said = gaitsim(capsys, "cite", written(tmp_path, '"winter2009: table 4.1"'))
    assert keys(said.out) == ["gaitsim", "todorov2012", "winter2009"]


def test_an_unknown_key_is_an_error_with_its_place(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = written(tmp_path, "gyer2003")
    said = gaitsim(capsys, "cite", path)
    assert (said.code, said.out) == (3, "")
    first = said.err.splitlines()[0]
    assert re.fullmatch(rf"{re.escape(path)}:4:\d+: pendulum.mass: the source gyer2003 is in no .*", first)
    assert first.endswith("Did you mean geyer2003?")


def test_a_bibliography_of_ones_own(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = written(tmp_path, "own2026")
    (tmp_path / "components").mkdir()
    entry = "@article{own2026,\n  title = {On {rods}}\n}"
    (tmp_path / "components" / "references.bib").write_text(f"{entry}\n", encoding="utf-8")
    said = gaitsim(capsys, "cite", path)
    assert said.code == 0
    assert entry in said.out


def test_every_algorithm_has_its_sources() -> None:
    known = read_bibliography([shipped_folder()])
    assert {key for entry in ALGORITHMS.values() for key in entry.citations} <= set(known)


def test_entries_are_split_at_the_brace_that_closes_them() -> None:
    text = "@a{x1,\n t = {{A} b}\n}\n% @no{y2,\n@b{z3, t={c}}"
    assert entries(text) == {"x1": "@a{x1,\n t = {{A} b}\n}", "z3": "@b{z3, t={c}}"}


@pytest.mark.parametrize(
    ("source", "found"),
    [
        ("geyer2003", ["geyer2003"]),
        ("geyer2003, force feedback", ["geyer2003"]),
        ("winter2009: table of Dempster's data", ["winter2009"]),
        ("definition: uniform rod, 1/sqrt(12)", []),
        ("thesis: last three", []),
    ],
)
def test_keys_are_words_of_letters_and_digits_before_the_colon(source: str, found: list[str]) -> None:
    assert keys_of(source) == found
