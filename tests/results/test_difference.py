"""The difference of two models: what each kind of change is called, and that nothing else is said to differ."""

from __future__ import annotations

from pathlib import Path

import pytest

from gaitsim.components.find import Library
from gaitsim.distribution import shipped_folder
from gaitsim.model import Model
from gaitsim.results.bundle import Bundle
from gaitsim.results.difference import Change, code_changes, counted, making_changes, model_changes
from gaitsim.spec.inheritance import override
from gaitsim.spec.resolve import read_spec, resolve
from tests.simulation.models import ROOT

SPEC = ROOT / "specs" / "hopping_geyer2003.yaml"


def hopper(*settings: tuple[str, str]) -> Model:
    document = read_spec(SPEC)
    for address, text in settings:
        document = override(document, address, text)
    return resolve(document, Library((shipped_folder(),)), "hopper")


def changes(*settings: tuple[str, str]) -> list[tuple[str, str, str, str]]:
    return [(c.what, c.where, c.first, c.second) for c in model_changes(hopper(), hopper(*settings))]


@pytest.mark.parametrize(
    ("settings", "expected"),
    [
        ([], []),
        ([("body.mass", "81 kg")], [("value", "body.mass", "80.0 kg", "81.0 kg")]),
        ([("feedback.gain.value", "3")], [("tuned value", "feedback.gain", "2.64", "3.0")]),
        ([("simulate.duration", "5 s")], [("simulation", "duration", "20.0 s", "5.0 s")]),
        (
            [("parts.more", "{use: sensor/mechanical_energy}")],
            [("part", "more", "", "sensor/mechanical_energy")],
        ),
        (
            [("parameters.arm", "{unit: m, default: 41 mm}"), ("extensor.path.moment_arm", "=arm")],
            [("value", "extensor.path.moment_arm", "0.04 m", "0.041 m (=arm)"), ("value", "arm", "", "0.041 m")],
        ),
    ],
    ids=["nothing", "a value", "a tuned value", "a setting", "a part", "an expression"],
)
def test_one_change_is_told_alone(settings: list[tuple[str, str]], expected: list[tuple[str, str, str, str]]) -> None:
    assert sorted(changes(*settings)) == sorted(expected)


def test_a_tuned_number_that_is_fixed_and_one_with_other_bounds() -> None:
    assert changes(("feedback.gain", "2.64")) == [("tuning", "feedback.gain", "1.0 to 15.0", "fixed")]
    assert changes(("feedback.gain.tune", "[1, 10]")) == [("tuning", "feedback.gain", "1.0 to 15.0", "1.0 to 10.0")]


def test_a_part_with_another_component() -> None:
    found = changes(("extensor.use", "muscle/geyer2010"))
    assert ("component", "extensor", "muscle/geyer2003", "muscle/geyer2010") in found
    # All that differs is in the muscle.
    assert all(where.startswith("extensor") for _, where, _, _ in found)


def test_a_part_that_only_one_has_is_told_without_what_is_in_it() -> None:
    found = changes(("parts.extra", "{use: segment/rod, mass: 1 kg, length: 1 m}"), ("parts.hang", JOINT))
    assert [(what, where) for what, where, _, _ in found] == [("part", "extra"), ("part", "hang")]


JOINT = "{use: joint/hinge, parent: body.center, child: extra.proximal}"


def test_another_sender() -> None:
    found = changes(("parts.feedback.to", "null"))
    assert ("connection", "extensor.excitation", "feedback.stimulation", "") in found


def test_values_that_follow_from_others_are_told_as_such() -> None:
    path = ROOT / "specs" / "hopping_leg_mass.yaml"
    models = []
    for mass in ("80 kg", "90 kg"):
        document = override(read_spec(path), "parameters.mass.default", mass)
        models.append(resolve(document, Library((shipped_folder(),)), "leg"))
    found = model_changes(*models)
    assert [c.where for c in found if c.what == "value"] == ["mass"]
    assert counted(found)["computed"] > 2


def test_code_is_compared_file_by_file() -> None:
    one = Bundle("a", {"spec.yaml": "x", "components/muscle/a.py": "1\n2\n", "components/muscle/kind.yaml": "a"})
    other = Bundle("b", {"spec.yaml": "y", "components/muscle/a.py": "1\n3\n4\n", "components/muscle/kind.yaml": "b"})
    (change,) = code_changes(one, other)
    assert (change.what, change.where) == ("code", "muscle/a.py")
    assert change.second.endswith(" (+2 -1 lines)")
    assert code_changes(one, one) == []


def test_searches_and_versions() -> None:
    one = {"gaitsim": "0.1", "versions": {"numpy": "1"}, "search": {"seed": 1, "population": 8}}
    other = {"gaitsim": "0.1", "versions": {"numpy": "2"}, "search": {"seed": 2, "population": 8}}
    assert making_changes(one, other) == [Change("search", "seed", "1", "2"), Change("version", "numpy", "1", "2")]
    assert making_changes(one, {}) == []
    assert [c.what for c in making_changes(one, {"gaitsim": "0.1", "versions": {"numpy": "2"}})] == ["version"]


def test_a_component_of_ones_own_with_other_code(tmp_path: Path) -> None:
    inner = "muscle/geyer2003.py"
    own = tmp_path / inner
    own.parent.mkdir()
    own.write_text((shipped_folder() / inner).read_text(encoding="utf-8").replace('default=0.01', 'default=0.011'))
    edited = resolve(read_spec(SPEC), Library((tmp_path, shipped_folder())), "hopper")
    assert all(c.what in ("value", "computed") for c in model_changes(hopper(), edited))
