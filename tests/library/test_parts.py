"""Activation, paths, legs and controllers: each equation by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest
from components.calls import Tables, computed, primitive

modes = pytest.mark.parametrize("mode", ["rapid", "normal"])


@pytest.mark.parametrize(("begin", "excitation"), [(0.0, 1.0), (1.0, 0.01), (0.3, 0.7)])
def test_first_order_step_response(begin: float, excitation: float) -> None:
    tau, dt = 0.01, 1e-6
    tables = Tables(primitive("activation/first_order")).put({"excitation": excitation})
    tables.put({"level": begin})
    for _ in range(round(tau / dt)):
        tables.call("update", "rapid", dt)
    tables.call("output", "rapid")
    exact = excitation + (begin - excitation) * math.exp(-1)
    assert tables.y.activation == pytest.approx(exact, abs=1e-4)


@modes
@pytest.mark.parametrize(("excitation", "activation"), [(0.5, 0.5), (-3, 0.01), (0, 0.01), (7, 1)])
def test_first_order_clips_and_starts_settled(excitation: float, activation: float, mode: str) -> None:
    tables = Tables(primitive("activation/first_order")).put({"excitation": excitation})
    tables.call("start", mode)
    assert tables.x.level == activation
    tables.call("update", mode, 1e-3)
    assert tables.x.level == activation


@modes
def test_constant_arm(mode: str) -> None:
    values = {"moment_arm": 0.04, "reference_length": 0.5, "reference_angle": math.radians(110)}
    now = computed(
        "path/constant_arm",
        mode,
        **values,
        angle=math.radians(140),
        angular_velocity=3.0,
        tension=1000.0,
    )
    assert now.length == pytest.approx(0.5 - 0.04 * math.radians(30), rel=1e-12)
    assert now.velocity == pytest.approx(-0.12, rel=1e-12)
    assert now.moment == pytest.approx(40)
    # Whatever the posture, the path loses the power that the joint gets.
    assert now.moment * 3.0 == pytest.approx(-1000.0 * now.velocity, rel=1e-12)


@modes
@pytest.mark.parametrize("length", [0.3, 0.7, 0.9, 0.98])
@pytest.mark.parametrize("velocity", [-2.0, 0.5])
def test_virtual_leg_in_stance(length: float, velocity: float, mode: str) -> None:
    leg = {"segment_length": 0.5, "landing_length": 0.99, "velocity": velocity}
    now = computed("leg/virtual_two_segment", mode, **leg, length=length, knee_moment=80.0)
    assert (now.in_stance, now.in_flight) == (1, 0)
    assert now.knee_angle == pytest.approx(2 * math.asin(length), rel=1e-12)
    assert now.force == pytest.approx(80 / math.sqrt(0.25 - length**2 / 4), rel=1e-12)
    # F v = M phi': a massless leg neither stores nor makes power.
    assert now.force * velocity == pytest.approx(80 * now.knee_velocity, rel=1e-12)
    ahead, behind = (
        computed("leg/virtual_two_segment", mode, **leg, length=length + s * 1e-6).knee_angle for s in (1, -1)
    )
    assert now.knee_velocity == pytest.approx((ahead - behind) / 2e-6 * velocity, rel=1e-6)


@modes
def test_virtual_leg_in_flight_waits_at_its_landing_length(mode: str) -> None:
    leg = {"segment_length": 0.5, "landing_length": 0.99, "velocity": -1.0, "knee_moment": 80.0}
    for length in (0.99, 1.5):
        now = computed("leg/virtual_two_segment", mode, **leg, length=length)
        assert (now.in_stance, now.in_flight, now.force, now.knee_velocity) == (0, 1, 0, 0)
        assert now.knee_angle == pytest.approx(2 * math.asin(0.99))


@modes
def test_muscle_feedback(mode: str) -> None:
    feedback = {"gain": 12.0, "offset": 0.8, "bias": 0.01}
    now = computed("controller/muscle_feedback", mode, **feedback, signal=0.9)
    assert now.stimulation == pytest.approx(0.01 + 12 * 0.1)
    now = computed("controller/muscle_feedback", mode, **feedback, signal=0.7, gate=1.0)
    assert now.stimulation == pytest.approx(0.01 - 12 * 0.1)
    now = computed("controller/muscle_feedback", mode, **feedback, signal=0.9, gate=0.0)
    assert now.stimulation == 0.01


@modes
def test_pid(mode: str) -> None:
    gains = {"proportional": 10.0, "integral": 4.0, "derivative": 2.0, "setpoint": 1.0}
    tables = Tables(primitive("controller/pid")).put({**gains, "angle": 0.5, "limit": 1e6})
    tables.put({"angular_velocity": -1.0})
    for _ in range(100):
        tables.call("update", mode, 0.01)
    assert tables.x.accumulated == pytest.approx(0.5)
    tables.call("output", mode)
    assert tables.y.torque == pytest.approx(10 * 0.5 + 4 * 0.5 + 2 * 1.0)
    for angle, torque in ((-100.0, 3.0), (100.0, -3.0)):
        tables.put({"limit": 3.0, "angle": angle}).call("output", mode)
        assert tables.y.torque == torque


@modes
def test_objectives(mode: str) -> None:
    assert computed("objective/maximize", mode, value=0.163, scale=0.1).cost == pytest.approx(-1.63)
    assert computed("objective/minimize", mode, value=0.163, scale=0.1).cost == pytest.approx(1.63)
    assert np.isnan(computed("objective/minimize", mode, value=math.nan).cost)


@modes
def test_mechanical_energy(mode: str) -> None:
    assert computed("sensor/mechanical_energy", mode, potential=3.0, kinetic=4.0).total == 7
