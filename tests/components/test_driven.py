"""Parameters that a signal sets: the same equations, with the parameter as an input."""

from __future__ import annotations

from pathlib import Path

import pytest

from components.calls import primitive
from gaitsim.components.driven import driven, obstacle
from gaitsim.components.find import Library, library_folders
from gaitsim.components.load import load_primitive
from gaitsim.simulation.run import Mode, Simulator
from gaitsim.simulation.trial import Trial
from gaitsim.spec.resolve import read_spec, resolve

modes = pytest.mark.parametrize("mode", ["rapid", "normal"])

SPEC = """\
gaitsim: 1
parts:
  asked: {use: controller/time_profile, times: [0 s, 1 s], values: [0.4, 0.4]}
  wave: {use: controller/clock, period: 0.3 s}
  reflex: {use: controller/pair, offset: GIVEN, signal: {from: wave.phase, delay: 20 ms}}
measures:
  mean: {use: measure/mean_square, signal: {from: reflex.sum}}
simulate: {duration: 1 s, step: 1 ms}
"""
PAIR = """\
about: Two reflexes with one offset.
parameters:
  offset: {unit: "1", default: 0.5, doc: Offset of both., source: "definition: a test"}
  other: {unit: "1", default: =offset, doc: Offset of the second., source: "definition: a test"}
inputs: {signal: [first.signal, second.signal]}
outputs: {sum: sum.stimulation}
parts:
  sum: {use: controller/clipped_sum, lower: 0, upper: 1}
  first: {use: controller/length_reflex, gain: 0.8, offset: =offset, to: sum.stimulations}
  second: {use: controller/length_reflex, gain: 0.1, offset: =other, to: sum.stimulations}
"""


def run_of(folder: Path, given: str, mode: Mode) -> dict[str, float]:
    """The metrics of the spec with a number or a signal for the offset."""
    path = folder / "spec.yaml"
    path.write_text(SPEC.replace("GIVEN", given), encoding="utf-8")
    (folder / "components" / "controller").mkdir(parents=True, exist_ok=True)
    (folder / "components" / "controller" / "pair.yaml").write_text(PAIR, encoding="utf-8")
    model = resolve(read_spec(path), Library(library_folders(path)), "spec")
    return Simulator(model, mode).run().metrics


@modes
def test_the_equations_stay(mode: Mode) -> None:
    kind = primitive("controller/length_reflex")
    values = {"gain": 1.7, "offset": 0.6, "signal": 0.9, "gate": 1.0}
    found = []
    for one in (kind, driven(kind, frozenset({"gain"})), driven(kind, frozenset({"gain", "offset"}))):
        trial = Trial(one).put(values)
        assert not trial.call("output", mode)
        found.append(float(trial.y.stimulation))
    assert found[0] != 0
    assert found == [found[0]] * 3


def test_it_is_an_input_on_which_outputs_depend() -> None:
    kind = primitive("controller/length_reflex")
    other = driven(kind, frozenset({"gain"}))
    assert "gain" in kind.parameters and "gain" not in kind.dependencies["stimulation"]
    assert "gain" not in other.parameters and "gain" in other.dependencies["stimulation"]
    assert other.inputs["gain"].possible == kind.parameters["gain"].bounds
    assert (other.digest, other.reference) == (kind.digest, kind.reference)
    assert len(other.text) == len(kind.text)


@pytest.mark.parametrize(
    ("reference", "name", "why"),
    [
        ("controller/phase_window", "begins", "controller/phase_window reads begins when the mechanics are built"),
        (
            "muscle/geyer2010",
            "max_contraction_velocity",
            "computes numbers of an inner part from max_contraction_velocity",
        ),
        ("measure/speed", "settle", "figures and metrics rely on the number settle of a measure"),
        ("controller/length_reflex", "gain", ""),
    ],
)
def test_what_stands_against_it(reference: str, name: str, why: str) -> None:
    assert why in obstacle(primitive(reference), name)
    assert bool(why) == bool(obstacle(primitive(reference), name))


def test_a_component_that_hands_on_all_parameters_keeps_them() -> None:
    text = """from gaitsim.component import Component, Output, Parameter

def twice(p):
    return 2 * p.level

class Twice(Component):
    level = Parameter("1", "Level.")
    other = Parameter("1", "Another.")
    value = Output("1", "Twice the level.")

    @staticmethod
    def output(p, u, x, y):
        y.value = twice(p)
"""
    kind = load_primitive("sensor/twice", Path("twice.py"), "twice.py", text)
    assert obstacle(kind, "other") == "sensor/twice hands all of its parameters to a function"


@modes
def test_a_constant_signal_is_the_number_also_within_a_composite(mode: Mode, tmp_path: Path) -> None:
    number = run_of(tmp_path, "0.4", mode)
    assert number["mean"] > 0
    assert run_of(tmp_path, "0.3", mode) != number
    assert run_of(tmp_path, "{from: asked.value}", mode) == number


def test_a_list_of_instants_that_ends_before_the_run_is_told(tmp_path: Path) -> None:
    path = tmp_path / "spec.yaml"
    text = "gaitsim: 1\nparts:\n  asked: {use: controller/time_profile, times: [0 s, 5 s], values: [1 m/s, 2 m/s]}\n"
    path.write_text(f"{text}simulate: {{duration: 8 s, step: 1 ms}}\n", encoding="utf-8")
    whole, longer = (
        resolve(read_spec(path, [("simulate.duration", time)]), Library(library_folders(path)), "spec").notices
        for time in ("5 s", "8 s")
    )
    assert whole == ()
    assert longer == ("warning: asked.times end at 5 s and the run lasts 8 s; the last value holds until then",)
