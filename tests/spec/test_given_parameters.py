"""What a part tells another without being asked: parameters down, a joint by its name, a step that is too long."""

from __future__ import annotations

from pathlib import Path

import pytest

from gaitsim.components.find import Library, library_folders
from gaitsim.errors import GaitsimError, InvalidSpec
from gaitsim.model import Model
from gaitsim.spec.resolve import read_spec, resolve

INNER = """from gaitsim.component import Component, Output, Parameter


class Inner(Component):
    \"\"\"An inner part.\"\"\"

    reach = Parameter("m", "A length.", default=7, source="definition: a choice")
    width = Parameter("m", "Another.", bounds=(0, 10))
    value = Output("m", "A length.")

    @staticmethod
    def output(p, u, x, y):
        y.value = p.reach + p.width
"""
OUTER = """from gaitsim.component import Component, Input, Output, Parameter, Part{more}


class Outer(Component):
    \"\"\"A part around another.\"\"\"

    length = Parameter("m", "A length.", bounds=(0, 10))
    inside = Part(
        "inner", "What is inside.", {default}gives=(("reach", "{reach}"), ("width", "length"), ("lack", "length"))
    )
    value = Output("m", "A length.")
{lines}
    @staticmethod
    def output(p, u, x, y):
        y.value = p.length
"""
SPEC = """
gaitsim: 1
parameters: {size: {unit: m, default: {value: 2 m, tune: [1 m, 3 m]}}}
parts:
  one: {use: outer/outer, length: =size INSIDE}
simulate: {duration: 1 s, step: 10 ms}
"""


def made(
    folder: Path,
    inside: str = "",
    reach: str = "2 * length",
    default: str = 'default="inner/inner", ',
    lines: str = "",
    more: str = "",
) -> Model:
    for kind, text in (
        ("inner", INNER),
        ("outer", OUTER.format(reach=reach, default=default, lines=lines, more=more)),
    ):
        place = folder / "components" / kind
        place.mkdir(parents=True, exist_ok=True)
        (place / f"{kind}.py").write_text(text, encoding="utf-8")
    spec = folder / "spec.yaml"
    spec.write_text(SPEC.replace("INSIDE", inside), encoding="utf-8")
    return resolve(read_spec(spec), Library(library_folders(spec)), "spec")


def values(model: Model, size: float) -> dict[str, float]:
    return dict(zip((n.address for n in model.numbers), model.values([size]), strict=True))


def test_an_inner_part_gets_parameters_of_the_part_around(tmp_path: Path) -> None:
    model = made(tmp_path)
    for size in (1.0, 2.5):
        found = values(model, size)
        assert found["one.inside.reach"] == 2 * size
        assert found["one.inside.width"] == size


def test_what_a_spec_says_stays(tmp_path: Path) -> None:
    found = values(made(tmp_path, ", inside: {reach: 5 m}"), 2)
    assert (found["one.inside.reach"], found["one.inside.width"]) == (5, 2)


def test_an_optional_part_is_there_if_a_spec_says_so(tmp_path: Path) -> None:
    without = made(tmp_path, default="optional=True, ")
    assert [part.address for part in without.parts] == ["one"]
    said = made(tmp_path, ", inside: {use: inner/inner}", default="optional=True, ")
    assert [part.address for part in said.parts] == ["one", "one.inside"]


def test_an_optional_part_needs_a_component(tmp_path: Path) -> None:
    with pytest.raises(InvalidSpec, match=r"needs inside \(What is inside\); write inside: \{use: inner/inner"):
        made(tmp_path, ", inside: {reach: 5 m}", default="optional=True, ")


@pytest.mark.parametrize(
    ("reach", "said"),
    [
        ("2 * lenght", "inside is given reach: "),
        ("2 *", "inside is given reach: =2 * cannot be read"),
    ],
)
def test_an_expression_that_is_none(reach: str, said: str, tmp_path: Path) -> None:
    with pytest.raises(GaitsimError) as error:
        made(tmp_path, reach=reach)
    assert said in str(error.value)
    assert "components/outer/outer.py:8:5" in str(error.value)


def test_a_unit_that_does_not_fit(tmp_path: Path) -> None:
    with pytest.raises(InvalidSpec, match=r"one.inside.reach: =length \* length gives an area; this needs a length"):
        made(tmp_path, reach="length * length")


def limited(tmp_path: Path, limit: str) -> Model:
    return made(tmp_path, lines=f"    largest_step = StepLimit({limit})\n", more=", StepLimit")


def test_a_step_longer_than_declared_is_told(tmp_path: Path) -> None:
    model = limited(tmp_path, '"ms", "Right to 1 % in a trial.", 2')
    (notice,) = model.notices
    assert notice == (
        "warning: outer/outer (one) is accurate up to a step of 2 ms, and simulate.step is 10 ms; "
        "see gaitsim library show outer/outer"
    )
    assert model.parts[0].type.largest_step == 0.002


@pytest.mark.parametrize("limit", ['"ms", "Right.", 10', '"s", "Right.", 0.01', '"s", "Right.", 1'])
def test_a_step_within_the_limit_is_not(limit: str, tmp_path: Path) -> None:
    assert limited(tmp_path, limit).notices == ()


@pytest.mark.parametrize(
    ("limit", "said"),
    [
        ('"m", "Right.", 2', 'largest_step: m is not a unit of time; write such as StepLimit("ms", "...", 0.5).'),
        ('"ms", "Right.", 0', "largest_step: value is 0; write a number above 0."),
        ('"ms", "Right.", value=1, most=2', "StepLimit has no most. "),
    ],
)
def test_a_limit_that_is_none(limit: str, said: str, tmp_path: Path) -> None:
    with pytest.raises(GaitsimError) as error:
        limited(tmp_path, limit)
    assert said in str(error.value)
