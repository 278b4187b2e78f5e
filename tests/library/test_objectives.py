"""Every objective on tables of metrics: what is better must cost less."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import jsonschema
import numpy as np
import pytest
from components.calls import FILES, Tables, computed, primitive

from gaitsim.components.find import Library
from gaitsim.distribution import shipped_folder
from gaitsim.simulation.run import Simulator
from gaitsim.spec.json_schema import spec_schema
from gaitsim.spec.resolve import resolve
from gaitsim.text.document import parse, plain

GOOD = {"fall_time": 20.0, "fell": 0.0, "distance": 26.0, "speed": 1.3, "cost_of_transport": 3.2}


def walk(**metrics: float) -> float:
    return float(computed("objective/walk", **{**GOOD, "terms": 0.0, **metrics}).cost)


def fallen(time: float, speed: float = 1.3) -> float:
    """The cost of a fall; early ones have no mean speed, and none has a cost of transport."""
    return walk(fall_time=time, fell=1.0, distance=speed * time, speed=math.nan, cost_of_transport=math.nan)


def test_every_objective_of_the_library_is_tested() -> None:
    texts = "".join(path.read_text(encoding="utf-8") for path in Path(__file__).parent.glob("test_*.py"))
    objectives = [f.stem for f in FILES if f.parent.name == "objective" and not f.stem.startswith("_")]
    untested = [name for name in objectives if f"objective/{name}" not in texts]
    assert untested == []


def test_minimize_and_maximize() -> None:
    assert computed("objective/minimize", value=3.0, scale=2.0).cost == 1.5
    assert computed("objective/maximize", value=3.0, scale=2.0).cost == -1.5


@pytest.mark.parametrize(("value", "cost"), [(4.0, 0), (5.0, 0), (5.5, 1.0), (7.0, 4.0), (math.nan, 100)])
def test_excess(value: float, cost: float) -> None:
    assert computed("objective/excess", value=value, threshold=5.0, weight=4.0, unit=2.0).cost == cost


@pytest.mark.parametrize(("value", "cost"), [(6.0, 0), (5.0, 0), (4.5, 1.0), (3.0, 4.0), (math.nan, 7)])
def test_shortfall(value: float, cost: float) -> None:
    assert computed("objective/shortfall", value=value, threshold=5.0, weight=4.0, unit=2.0, missing=7.0).cost == cost


@pytest.mark.parametrize(("value", "cost"), [(1.3, 0), (1.25, 0), (1.0, 2.0), (1.6, 2.0), (math.nan, 100)])
def test_deviation(value: float, cost: float) -> None:
    found = computed("objective/deviation", value=value, target=1.3, tolerance=0.1, weight=10.0)
    assert found.cost == pytest.approx(cost)


def test_a_walk_is_judged_by_its_cost_of_transport_and_what_it_strains() -> None:
    assert walk() == pytest.approx(3.2)
    assert walk(speed=1.21) == walk(speed=1.39) == pytest.approx(3.2)
    assert walk(limit_torque=5.0) == pytest.approx(3.2 + 0.5)
    assert walk(load_excess=0.02) == pytest.approx(3.2 + 0.2)
    assert walk(terms=1.5) == pytest.approx(4.7)
    assert walk(limit_torque=5.0, torque_threshold=4.0) == pytest.approx(3.2 + 0.1)


def test_a_later_fall_costs_less_and_any_walk_costs_less_than_any_fall() -> None:
    times = np.linspace(0, 1000, 4001)
    costs = [fallen(t) for t in times]
    assert np.all(np.diff(costs) < 0)
    assert costs[0] == 300 and costs[-1] > 200
    assert fallen(3) < fallen(1)
    worst = max(walk(speed=v) for v in (-50.0, -1.0, 0.0, 50.0))
    assert worst < 200 < fallen(1e9)


def test_of_two_falls_at_one_time_the_one_that_walked_further_costs_less() -> None:
    assert fallen(3, 1.3) < fallen(3, 0.5) < fallen(3, 0.0)
    # Neither falling backwards nor flying past the target speed is worth anything.
    assert fallen(3, -1.0) == fallen(3, 0.0)
    assert fallen(3, 5.0) == fallen(3, 1.3)


def test_who_stands_still_beats_no_one_who_walks() -> None:
    standing = walk(fall_time=20.0, distance=0.5, speed=0.0)
    assert fallen(1) < standing == fallen(0.5 / 1.3)
    slow, slower = (walk(fall_time=20.0, distance=20 * v, speed=v) for v in (0.66, 0.64))
    assert 100 < slow < 200 < slower < fallen(9)


def test_speed_counts_before_effort() -> None:
    misses = [walk(speed=1.3 + sign * off) for off in np.linspace(0.101, 3, 50) for sign in (1, -1)]
    assert min(misses) > 100 and max(misses) < 200
    assert np.all(np.diff(misses[::2]) > 0) and np.all(np.diff(misses[1::2]) > 0)
    assert walk(cost_of_transport=1e9) < 100 < walk(speed=1.19, cost_of_transport=0.1)
    assert walk(speed=1.19) == pytest.approx(100 + 100 * 0.01 / 1.31)


def test_costs_of_the_last_stage_grow_without_a_jump() -> None:
    transport = np.linspace(0.1, 500, 50000)
    tables, found = Tables(primitive("objective/walk")).put({**GOOD, "terms": 0.0}), []
    for each in transport:
        tables.u.cost_of_transport = each
        assert not tables.call("output")
        found.append(tables.y.cost)
    costs = np.array(found)
    slopes = np.diff(costs) / np.diff(transport)
    assert np.all(slopes > 0) and costs[-1] < 100
    assert np.max(np.abs(np.diff(slopes))) < 1e-3
    assert np.all(costs[transport < 50] == pytest.approx(transport[transport < 50]))


def test_a_walk_without_some_metric_is_the_worst_of_its_stage() -> None:
    assert walk(cost_of_transport=math.nan) == walk(limit_torque=math.nan) == 100
    assert walk(terms=math.inf) == 100
    assert walk(speed=math.nan) == 200


SPEC = """\
gaitsim: 1
parts:
  pendulum: {use: segment/rod, mass: 2 kg, length: 1 m}
  pivot: {use: joint/hinge, parent: world, child: pendulum.proximal}
initial: {pivot.angle: 90 deg}
measures:
  swing: {use: measure/range, signal: {from: pivot.angle}}
  cadence: {use: measure/cadence, left: 0, right: 0}
  effort: {use: measure/effort, signal: 0.5}
objective:
  use: objective/weighted_sum
  terms:
    swing: {use: objective/deviation, value: {from: swing.high}, target: 60 deg, unit: 1 deg, weight: 2}
    cadence: {use: objective/excess, value: {from: cadence}, missing: 7}
    rest:
      use: objective/weighted_sum
      scale: 2
      terms: {effort: {use: objective/minimize, value: {from: effort}}}
simulate: {duration: 1 s, step: 1 ms}
"""


def outcome(text: str) -> Any:
    return Simulator(resolve(parse(text, "spec.yaml"), Library((shipped_folder(),)), "spec")).run()


def test_terms_are_objectives_whose_costs_are_added() -> None:
    found = outcome(SPEC)
    assert found.metrics["swing.high"] == math.pi / 2
    assert found.score == pytest.approx(2 * 30 + 7 + 0.25 / 2, rel=1e-12)


def test_the_schema_knows_terms() -> None:
    check = jsonschema.Draft202012Validator(spec_schema(Library((shipped_folder(),))))
    assert list(check.iter_errors(plain(parse(SPEC, "spec.yaml")))) == []
    wrong = plain(parse(SPEC.replace("weight: 2", "wight: 2"), "spec.yaml"))
    assert any("'wight' was unexpected" in error.message for error in check.iter_errors(wrong))


def test_a_term_may_read_a_metric_of_its_own_name() -> None:
    only = SPEC.replace("value: {from: swing.high}", "value: {from: swing}")
    assert outcome(only).score > 7


_TILT = '''\
from gaitsim.component import Component, Input, Metric, State


class Tilt(Component):
    """The last angle, in degrees."""

    angle = Input("rad", "An angle.")
    last = State("rad", "The last angle.")
    value = Metric("deg", "The last angle.")

    @staticmethod
    def start(p, u, x):
        x.last = u.angle

    @staticmethod
    def finish(p, x, m):
        m.value = x.last
'''


def test_metrics_are_reported_in_their_units_and_scored_in_si(tmp_path: Path) -> None:
    (tmp_path / "measure").mkdir()
    (tmp_path / "measure" / "tilt.py").write_text(_TILT)
    head = SPEC.partition("measures:")[0]
    text = head + (
        "measures: {tilt: {use: measure/tilt, angle: {from: pivot.angle}}}\n"
        "objective: {use: objective/minimize, value: {from: tilt}}\n"
        "simulate: {duration: 1 s, step: 1 ms}\n"
    )
    model = resolve(parse(text, "spec.yaml"), Library((tmp_path, shipped_folder())), "spec")
    assert model.metrics == {"tilt": "deg"}
    found = Simulator(model).run()
    assert found.metrics["tilt"] == pytest.approx(90)
    assert found.score == pytest.approx(math.pi / 2)
