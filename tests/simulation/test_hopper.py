"""The published hopper (Geyer, Seyfarth & Blickhan 2003) against an independent solution by explicit
Euler at 0.01 ms. The simulator is semi-implicit, so both are equal in the limit of small steps."""

from __future__ import annotations

import math
from functools import cache

import numpy as np
import pytest
from numpy.typing import NDArray

from gaitsim.simulation.outcome import Outcome, Trajectory

from .models import HOPPER, simulator

APEX = 0.162978
TOUCHDOWN = -math.sqrt(2 * 9.81 * APEX)
TRACED = ("guide.position", "guide.velocity", "leg.force", "extensor.activation")
TRACED += ("extensor.fiber_length",)


def hops(start: float, step: str, duration: float, recorded: bool = False, **more: str) -> Outcome:
    """A run from rest at an apex `start` above the landing length."""
    settings = {"initial.guide.position": f"{0.99 + start} m", "simulate.step": step}
    settings |= {"simulate.duration": f"{duration} s"}
    settings |= {name.replace("__", "."): text for name, text in more.items()}
    outcome = simulator(HOPPER, settings.items()).run(recorded=recorded)
    assert outcome.status == "completed", outcome.reason
    return outcome


@cache
def stance() -> Trajectory:
    """One stance from touchdown at the fixed point.

    0.01 ms, the step of the reference: at 0.02 s and at 0.36 s the force changes by several per
    cent in 0.1 ms, so that a step of 0.1 ms alone would miss 1 %.
    """
    settings = [
        ("initial.guide.position", "0.99 m"),
        ("initial.guide.velocity", f"{TOUCHDOWN!r} m/s"),
        ("simulate.step", "0.01 ms"),
        ("simulate.duration", "0.4 s"),
    ]
    outcome = simulator(HOPPER, settings).run(recorded=True)
    assert outcome.trajectory is not None, outcome.reason
    return outcome.trajectory


def integrated(step: float, until: float) -> NDArray[np.float64]:
    """The published equations, written out once more: explicit Euler from touchdown.

    Rows of (t, y, y', F_leg, A, l_CE).
    """
    mass, gravity, segment, landing, arm = 80.0, 9.81, 0.5, 0.99, 0.04
    f_max, optimal, rest, width, n, k, v_max = 22e3, 0.1, 0.4, 0.4, 1.5, 5.0, 1.2
    y, speed, activation, past = landing, TOUCHDOWN, 0.01, [0.0] * round(0.015 / step)
    rows = []

    def path(leg: float) -> float:
        return 0.5 - arm * (2 * math.asin(leg / (2 * segment)) - math.radians(110))

    fiber = path(landing) - rest
    for i in range(round(until / step) + 1):
        normalized = (max(0.0, path(y) - fiber - rest) / rest / 0.04) ** 2
        force = f_max * normalized * arm / math.sqrt(segment**2 - y * y / 4)
        rows.append((i * step, y, speed, force, activation, fiber))
        delayed = past[i % len(past)]
        past[i % len(past)] = normalized
        f_l = math.exp(math.log(0.05) * abs((fiber - optimal) / (optimal * width)) ** 3)
        ratio = normalized / (activation * f_l)
        if ratio <= 1:
            velocity = (ratio - 1) / (1 + k * ratio)
        elif ratio <= n:
            velocity = (1 + (ratio - n) / (n - 1)) / (1 - 7.56 * k * (ratio - n) / (n - 1))
        else:
            velocity = 1 + 0.01 * (ratio - n)
        y, speed = y + speed * step, speed + (force / mass - gravity) * step
        fiber += velocity * v_max * step
        stimulation = min(1.0, max(0.01, 0.01 + 2.64 * delayed))
        activation += (stimulation - activation) * step / 0.01
    return np.array(rows)


def test_the_published_height_at_the_published_gain() -> None:
    metrics = hops(0.05, "0.1 ms", 14).metrics
    assert metrics["apex_height"] == pytest.approx(0.1630, abs=0.0005)
    assert metrics["apex_height.spread"] < 1e-4
    assert metrics["contact_time"] == pytest.approx(0.3683, rel=0.01)
    assert metrics["peak_force"] == pytest.approx(3496, rel=0.01)
    assert metrics["hopping_frequency"] == pytest.approx(1.365, rel=0.01)


@pytest.mark.parametrize(
    ("gain", "height", "contact", "peak", "frequency"),
    [
        (1.5, 0.0889, 0.472, 3165, 1.35),
        (2.4, 0.1617, 0.383, 3455, 1.34),
        (2.64, 0.1630, 0.3683, 3496, 1.365),
        (4, 0.1503, 0.320, 3554, 1.49),
        (10, 0.0869, 0.268, 3191, 1.87),
        (15, 0.0585, 0.256, 2894, 2.11),
    ],
)
def test_steady_hopping_at_each_gain(gain: float, height: float, contact: float, peak: float, frequency: float) -> None:
    # 0.02 ms: the error of the scheme grows with the gain; at 0.1 ms it is 1.7 % of the height at 15.
    outcome = hops(height, "0.02 ms", 8, feedback__gain=str(gain))
    metrics = outcome.metrics
    assert metrics["apex_height.hops"] >= 9
    assert metrics["apex_height.spread"] < 1e-4
    assert metrics["apex_height"] == pytest.approx(height, rel=0.01)
    assert metrics["contact_time"] == pytest.approx(contact, rel=0.01)
    assert metrics["peak_force"] == pytest.approx(peak, rel=0.01)
    assert metrics["hopping_frequency"] == pytest.approx(frequency, rel=0.01)


@pytest.mark.parametrize(
    ("before", "after"),
    [
        (0.01, 0.0853),
        (0.05, 0.1208),
        (0.09, 0.1417),
        (0.13, 0.1552),
        (0.163, 0.16299),
        (0.20, 0.1699),
        (0.30, 0.1833),
        (0.40, 0.1834),
    ],
)
def test_return_map(before: float, after: float) -> None:
    trajectory = hops(before, "0.1 ms", 1.4, recorded=True).trajectory
    assert trajectory is not None
    in_stance = trajectory["leg.in_stance"] > 0.5
    takeoff = np.flatnonzero(in_stance[:-1] & ~in_stance[1:])[0]
    next_touchdown = np.flatnonzero(in_stance[takeoff + 1 :])
    end = takeoff + 1 + next_touchdown[0] if len(next_touchdown) else len(in_stance)
    height = trajectory["guide.position"][takeoff + 1 : end] - 0.99
    assert 0 < int(np.argmax(height)) < len(height) - 1  # the apex itself, not the end of the run
    assert height.max() == pytest.approx(after, rel=0.01)


@pytest.mark.parametrize(
    ("step", "height", "allowed"),
    [
        # At 1 ms touchdown falls anywhere within a step: single hops differ by 2.4 mm.
        ("1 ms", 0.1662, 0.0010),
        ("0.5 ms", 0.1646, 0.0005),
        ("0.2 ms", 0.1632, 0.0002),
        ("0.1 ms", 0.1630, 0.0001),
    ],
)
def test_heights_at_coarser_steps(step: str, height: float, allowed: float) -> None:
    metrics = hops(0.16, step, 14, apex_height__average="16").metrics
    assert metrics["apex_height"] == pytest.approx(height, abs=allowed)


@pytest.mark.parametrize(
    ("time", "position", "velocity", "force", "activation", "fiber_length"),
    [
        (0.02, 0.95233, -1.9773, 46.3, 0.01179, 0.07450),
        (0.06, 0.86645, -2.2916, 366.3, 0.0782, 0.08779),
        (0.10, 0.77477, -2.1396, 2198.9, 0.7145, 0.09166),
        (0.14, 0.71087, -0.9517, 3461.0, 0.9948, 0.09472),
        (0.20, 0.70937, 0.7905, 2558.4, 1.0, 0.09751),
        (0.30, 0.85758, 1.9048, 1181.2, 1.0, 0.08495),
        # `integrated` gives 111.1 N at this step and 110.7 N in the limit.
        (0.36, 0.97490, 1.8634, 111.1, 0.389, 0.06718),
    ],
)
def test_stance_trace_of_the_independent_solution(
    time: float,
    position: float,
    velocity: float,
    force: float,
    activation: float,
    fiber_length: float,
) -> None:
    row = round(time / 1e-5)
    now = [stance()[signal][row] for signal in TRACED]
    assert now == pytest.approx([position, velocity, force, activation, fiber_length], rel=0.01)


def test_stance_trace_of_the_equations_written_out_once_more() -> None:
    reference = integrated(1e-5, 0.36)
    scale = np.abs(reference[:, 1:]).max(axis=0)
    ours = np.stack([stance()[signal][: len(reference)] for signal in TRACED], axis=1)
    assert np.abs((ours - reference[:, 1:]) / scale).max() < 1e-3


def test_energy_in_flight_falls_as_the_scheme_says() -> None:
    for step, dt in (("1 ms", 1e-3), ("0.1 ms", 1e-4)):
        trajectory = hops(0.3, step, 0.2, recorded=True).trajectory
        assert trajectory is not None
        assert np.all(trajectory["leg.in_flight"] == 1)
        potential, kinetic = trajectory["energy.potential"], trajectory["energy.kinetic"]
        np.testing.assert_allclose(potential, 80 * 9.81 * trajectory["guide.position"], rtol=1e-12)
        np.testing.assert_allclose(kinetic, 40 * trajectory["guide.velocity"] ** 2, rtol=1e-12)
        total = trajectory["energy.total"]
        np.testing.assert_allclose(total, potential + kinetic, rtol=1e-12)
        # Semi-implicit Euler under constant force loses exactly m g^2 dt^2 / 2 a step.
        loss = 80 * 9.81**2 * dt * trajectory.times / 2
        np.testing.assert_allclose(total[0] - total, loss, rtol=1e-6, atol=1e-9)


def test_the_leg_hands_the_muscle_s_power_on_and_the_tendon_keeps_the_rest() -> None:
    trajectory = stance()
    standing = trajectory["leg.in_stance"] == 1
    dt = 1e-5
    force, path_velocity = trajectory["extensor.force"], trajectory["extensor.path.velocity"]
    on_body = trajectory["leg.force"] * trajectory["guide.velocity"]
    np.testing.assert_allclose(on_body[standing], -(force * path_velocity)[standing], rtol=1e-9)
    # What the path does not get, the contractile element does, or the tendon stores.
    fiber_power = force * trajectory["extensor.fiber_velocity"]
    middle = np.flatnonzero(standing)[: np.count_nonzero(standing) // 2]
    work = np.sum((force * path_velocity - fiber_power)[middle]) * dt
    stored = trajectory["extensor.tendon_energy"][middle[-1] + 1]
    assert stored > 50
    assert work == pytest.approx(stored, rel=1e-3)
    # Over the whole stance the body gains what the contractile element does, and gravity takes.
    whole = np.flatnonzero(standing)
    gained = np.diff(trajectory["energy.total"][[whole[0], whole[-1]]])[0]
    assert gained == pytest.approx(-np.sum(fiber_power[whole]) * dt, abs=0.5)
