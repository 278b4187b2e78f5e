"""What a profile says of a model in which one part is known to cost most."""

from __future__ import annotations

import numpy as np
import pytest

from gaitsim.compiler.program import Program
from gaitsim.components.find import Library
from gaitsim.distribution import shipped_folder
from gaitsim.errors import SimulationFailed
from gaitsim.model import Model
from gaitsim.simulation.native_loop import NativeLoop
from gaitsim.simulation.profile import LOOP, OTHER, Profile, profile
from gaitsim.spec.resolve import resolve
from gaitsim.text.document import parse

SLOW = '''\
import math

from gaitsim.component import Component, Input, Output


class Slow(Component):
    """A sine, in a slow way."""

    angle = Input("rad", "Angle.")
    sine = Output("1", "Sine.")

    @staticmethod
    def output(p, u, x, y):
        total = 0.0
        for i in range(300):
            total = total + math.sin(u.angle + i)
        y.sine = total
'''
SPEC = """
gaitsim: 1
parts:
  rod: {use: segment/rod, mass: 1 kg, length: 1 m}
  pivot: {use: joint/hinge, parent: world, child: rod.proximal}
  slow: {use: sensor/slow, angle: {from: pivot.angle}}
initial: {pivot.angle: 30 deg}
measures:
  most: {use: measure/peak, signal: {from: slow.sine}}
  swing: {use: measure/range, signal: {from: pivot.angle}}
  again: {use: measure/range, signal: {from: pivot.velocity}}
simulate: {duration: 5 s, step: 1 ms}
"""


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Model:
    folder = tmp_path_factory.mktemp("components")
    (folder / "sensor").mkdir()
    (folder / "sensor" / "slow.py").write_text(SLOW)
    return resolve(parse(SPEC, "spec.yaml"), Library((folder, shipped_folder())), "spec")


@pytest.fixture(scope="module")
def found(made: Model) -> Profile:
    return profile(made)


def test_the_slow_part_costs_most(found: Profile) -> None:
    assert found.costs[0].name == "slow"
    assert found.costs[0].seconds > 0.5 * found.measured
    assert [cost.seconds for cost in found.costs] == sorted((cost.seconds for cost in found.costs), reverse=True)


def test_every_part_and_every_stage_of_mujoco_has_its_cost(made: Model, found: Profile) -> None:
    names = {cost.name: cost for cost in found.costs}
    assert {part.address for part in made.parts} < names.keys()
    assert {"kinematics", "velocity", "integration", LOOP} < names.keys()
    assert names["kinematics"].seconds > 0
    assert (names["rod"].calls, names["slow"].calls, names["most"].calls) == (0, 1, 2)
    assert found.steps == 5000


def test_functions_of_mujoco_that_are_called_alone_have_their_stages(made: Model, found: Profile) -> None:
    names = {cost.name: cost.calls for cost in found.costs if cost.use == "MuJoCo"}
    stages = ("kinematics", "inertia", "transmission", "velocity", "actuation", "acceleration", "solver", "integration")
    assert names == dict.fromkeys(stages, 1)
    spec = parse(SPEC.replace("5 s, step: 1 ms", "0.5 s, step: 1 ms, integrator: rk4"), "spec.yaml")
    steps = profile(resolve(spec, Library((made.parts[2].type.path.parents[1], shipped_folder())), "spec"))
    calls = {cost.name: cost.calls for cost in steps.costs if cost.use == "MuJoCo"}
    assert (calls["kinematics"], calls[OTHER]) == (4, 3)


def test_costs_add_up_to_the_step(found: Profile) -> None:
    assert 0.2 < found.measured / found.step < 5
    assert found.slower > 0.2
    together = found.by_component()
    assert sum(cost.seconds for cost in together) == pytest.approx(found.measured)
    (ranges,) = [cost for cost in together if cost.name == "measure/range"]
    assert ranges.seconds == pytest.approx(sum(c.seconds for c in found.costs if c.use == "measure/range"))


def test_the_stopwatch_changes_no_number(made: Model) -> None:
    plain, timed = (NativeLoop(Program(made), timed=timed) for timed in (False, True))
    for each in (plain, timed):
        each.prepare()
    one, other = (each.run(made.values(), 500, recorded=True) for each in (plain, timed))
    assert one.record is not None and other.record is not None
    assert one.record.tobytes() == other.record.tobytes()
    assert np.array_equal(one.x, other.x)


def test_a_run_that_fails_has_no_profile(made: Model) -> None:
    text = SPEC.replace("pivot.angle: 30 deg", "pivot.velocity: 1e300 rad/s")
    broken = resolve(parse(text, "spec.yaml"), Library((made.parts[2].type.path.parents[1], shipped_folder())), "spec")
    with pytest.raises(SimulationFailed, match=r"no finite number|diverge"):
        profile(broken)
