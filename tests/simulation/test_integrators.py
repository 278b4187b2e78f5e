"""Orders of the integrators, against tiny steps: mechanics alone, and mechanics that parts drive."""

from __future__ import annotations

from functools import cache

import mujoco
import numpy as np
import pytest

from gaitsim.compiler.mjcf import assemble
from gaitsim.errors import InvalidSpec
from gaitsim.simulation.outcome import Trajectory
from gaitsim.simulation.run import Mode, Simulator

from .models import OWN, written

PENDULUM = (OWN / "double_pendulum.yaml").read_text(encoding="utf-8")
FLIGHT = (OWN / "free_flight.yaml").read_text(encoding="utf-8")
SPRING = (OWN / "spring_pendulum.yaml").read_text(encoding="utf-8")
MODELS = {"pendulum": (PENDULUM, "hip.angle"), "flight": (FLIGHT, "hip.angle"), "spring": (SPRING, "pivot.angle")}


def run(text: str, scheme: str, step: float, mode: Mode = "rapid", duration: float = 0.5) -> Trajectory:
    settings = {"integrator": scheme, "step": f"{step} s", "duration": f"{duration} s"}
    outcome = Simulator(written(text, [(f"simulate.{k}", v) for k, v in settings.items()]), mode).run(recorded=True)
    assert outcome.status == "completed", outcome.reason
    assert outcome.trajectory is not None
    return outcome.trajectory


@cache
def exact(name: str) -> float:
    text, signal = MODELS[name]
    return float(run(text, "rk4", 6.25e-5)[signal][6400])


@pytest.mark.parametrize(
    ("name", "scheme", "order"),
    [
        ("pendulum", "euler", 1),
        ("pendulum", "rk4", 4),
        ("flight", "euler", 1),
        ("flight", "rk4", 4),
        ("spring", "euler", 1),
        ("spring", "rk4", 2),
    ],
)
def test_order(name: str, scheme: str, order: int) -> None:
    text, signal = MODELS[name]
    errors = [abs(run(text, scheme, step)[signal][round(0.4 / step)] - exact(name)) for step in (4e-3, 2e-3, 1e-3)]
    found = np.log2(np.divide(errors[:-1], errors[1:]))
    assert found == pytest.approx([order, order], abs=0.25)


def test_a_passive_pendulum_keeps_its_energy() -> None:
    """Euler loses 0.1 J of 10.5 in 1 s at 1 ms, rk4 4e-9 of it."""
    change = {scheme: run(PENDULUM, scheme, 1e-3, duration=5)["energy.total"] for scheme in ("euler", "rk4")}
    assert np.ptp(change["rk4"]) < 1e-7
    assert np.ptp(change["euler"]) > 0.1


@pytest.mark.parametrize("text", [PENDULUM, SPRING])
def test_both_modes_are_equal(text: str) -> None:
    rapid, normal = (run(text, "rk4", 1e-3, mode, 0.2) for mode in ("rapid", "normal"))
    assert np.array_equal(rapid.values, normal.values)


def test_without_driven_parts_it_is_mujocos_own_step() -> None:
    used = written(PENDULUM, [("simulate.integrator", "rk4")])
    model = assemble(used, used.values()).model
    data = mujoco.MjData(model)
    data.qpos[:] = np.radians([100, 10])
    for _ in range(499):
        mujoco.mj_step(model, data)
    assert run(PENDULUM, "rk4", 1e-3)["hip.angle"][499] == data.qpos[0]


def test_it_is_refused_where_velocity_terms_need_an_implicit_scheme() -> None:
    text = PENDULUM.replace("joint/hinge, parent: thigh", "joint/geyer2010, grows: forwards, parent: thigh")
    text = text.replace("knee.angle: 10 deg", "knee.angle: 0.1 rad")
    with pytest.raises(InvalidSpec) as raised:
        Simulator(written(text, [("simulate.integrator", "rk4")]))
    (fault,) = raised.value.faults
    assert fault.address == "knee"
    assert fault.message == (
        "its velocity terms need an implicit scheme, and integrator: rk4 is explicit; choose automatic."
    )
    assert fault.mark is not None
    assert fault.mark.line == 7
