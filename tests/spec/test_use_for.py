"""`use_for`: one line swaps a whole kind, with numbers, and leaves what the swapped-in part is made of."""

from __future__ import annotations

from pathlib import Path

import pytest

from gaitsim.components.find import Library, library_folders
from gaitsim.errors import GaitsimError
from gaitsim.model import Model
from gaitsim.spec.resolve import read_spec, resolve

SPEC = """
gaitsim: 1
use_for: USED
parts:
  block: {use: segment/point_mass, mass: 80 kg}
  root: {use: joint/planar, parent: world, child: block.center}
  first: {use: contact/mujoco, frame: block.center, radius: 1 cm, time_constant: 5 ms}
  second: {use: contact/spring_damper, frame: block.center, stiffness: 1 kN/m, damping: 0 N s/m}
simulate: {duration: 1 s, step: 1 ms}
"""


def model(folder: Path, used: str, *settings: tuple[str, str]) -> Model:
    path = folder / "spec.yaml"
    path.write_text(SPEC.replace("USED", used), encoding="utf-8")
    return resolve(read_spec(path, settings), Library(library_folders(path)), "spec")


def number(found: Model, address: str) -> float:
    part, _, name = address.rpartition(".")
    index = next(p.numbers[name] for p in found.parts if p.address == part)
    return found.values()[index]


def references(found: Model) -> dict[str, str]:
    return {part.address: part.type.reference for part in found.parts}


def test_a_kind_inside_of_parts_with_a_number(tmp_path: Path) -> None:
    found = model(tmp_path, "{terrain: {use: terrain/steps, first: 2 m, rise: -3 cm}}")
    assert references(found)["first.terrain"] == references(found)["second.terrain"] == "terrain/steps"
    assert number(found, "first.terrain.rise") == number(found, "second.terrain.rise") == pytest.approx(-0.03)
    assert found.notices == (
        "warning: contact/spring_damper (second) is accurate up to a step of 0.5 ms, "
        "and simulate.step is 1 ms; see gaitsim library show contact/spring_damper",
    )


def test_a_number_of_it_from_the_command_line(tmp_path: Path) -> None:
    used = "{terrain: {use: terrain/steps, first: 2 m, rise: -3 cm}}"
    found = model(tmp_path, used, ("use_for.terrain.rise", "4 cm"))
    assert number(found, "second.terrain.rise") == pytest.approx(0.04)


def test_words_that_the_new_part_lacks_are_dropped_and_said(tmp_path: Path) -> None:
    found = model(tmp_path, "{contact: contact/geyer2010}")
    assert references(found)["first"] == references(found)["second"] == "contact/geyer2010"
    assert "first: contact/geyer2010 has no radius; dropped" in found.notices
    assert "second: contact/geyer2010 has no stiffness; dropped" in found.notices


def test_a_composite_of_the_same_kind_keeps_its_inner_part(tmp_path: Path) -> None:
    found = model(tmp_path, "{contact: {use: contact/yielding_sole, depth: 5 mm}}")
    assert references(found)["first.sphere"] == references(found)["second.sphere"] == "contact/mujoco"
    assert number(found, "first.sphere.reference_stiffness") == pytest.approx(9.81 * 0.5 / 0.005)
    assert number(found, "first.sphere.radius") == pytest.approx(0.01)  # what the entry had said


@pytest.mark.parametrize(
    ("used", "said"),
    [
        ("{terrain: 3}", "this names no component; write terrain: terrain/..., or {use: terrain/..., ...}"),
        ("{terrain: {first: 2 m}}", "this names no component; write terrain: terrain/..."),
        ("{terrain: {use: contact/mujoco}}", "contact/mujoco is not a terrain; choose terrain/flat"),
        ("{terrain: {use: terrain/slope, angel: 3 deg}}", "terrain/slope has no angel. Did you mean angle?"),
    ],
)
def test_mistakes(tmp_path: Path, used: str, said: str) -> None:
    with pytest.raises(GaitsimError) as error:
        model(tmp_path, used)
    assert said in str(error.value)
