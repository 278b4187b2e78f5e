"""Raibert's hopper: height against the closed form of its hop, speed and attitude held, and where its energy goes."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import brentq

import gaitsim

SPEC = Path(__file__).parents[2] / "specs" / "hopping_raibert.yaml"
MASS, STIFFNESS, DAMPING, LENGTH, GRAVITY = 10.0, 2000.0, 15.0, 0.6, 9.81


def metrics(**settings: str) -> dict[str, float]:
    outcome = gaitsim.run(SPEC, settings, save=False).outcomes[0]
    assert outcome.status == "completed", outcome.reason
    return dict(outcome.metrics)


def spring(time: float, rest: float, height: float, speed: float) -> tuple[float, float]:
    """Height and speed on a spring with a damper, in closed form."""
    decay = DAMPING / (2 * MASS)
    omega = math.sqrt(STIFFNESS / MASS - decay**2)
    middle = rest - MASS * GRAVITY / STIFFNESS
    first, second = height - middle, (speed + decay * (height - middle)) / omega
    cosine, sine, fading = math.cos(omega * time), math.sin(omega * time), math.exp(-decay * time)
    swing = first * cosine + second * sine
    rate = omega * (second * cosine - first * sine)
    return middle + fading * swing, fading * (rate - decay * swing)


def next_apex(apex: float, thrust: float) -> float:
    """The apex after one at this height: fall, compression, thrust, extension until the force ends, rise."""
    fall = -math.sqrt(2 * GRAVITY * (apex - LENGTH))
    bottom = brentq(lambda time: spring(time, LENGTH, LENGTH, fall)[1], 1e-4, 0.2)
    lowest = spring(bottom, LENGTH, LENGTH, fall)[0]

    def force(time: float) -> float:
        height, speed = spring(time, LENGTH + thrust, lowest, 0.0)
        return STIFFNESS * (LENGTH + thrust - height) - DAMPING * speed

    height, speed = spring(brentq(force, 1e-3, 0.2), LENGTH + thrust, lowest, 0.0)
    return height + speed**2 / (2 * GRAVITY)


@pytest.mark.parametrize("thrust", [0.02, 0.025, 0.035])
def test_the_thrust_sets_the_height_as_the_closed_form_says(thrust: float) -> None:
    expected = brentq(lambda apex: next_apex(apex, thrust) - apex, LENGTH + 0.01, LENGTH + 1)
    found = gaitsim.cycle(SPEC, {"speed": "0 m/s", "thrust": f"{thrust} m", "initial_apex_height": f"{expected:.2f} m"})
    assert found.start["initial_apex_height"] == pytest.approx(expected, rel=1e-8)
    assert abs(found.start["initial_apex_speed"]) < 1e-9 and abs(found.start["initial_apex_pitch"]) < 1e-9


@pytest.mark.parametrize("speed", [-1.0, 1.0, 2.0])
def test_a_speed_is_held_with_the_error_of_the_neutral_point(speed: float) -> None:
    """The hip is slower in stance than in the air, so v T_s/2 lies ahead of the neutral point and brakes."""
    found = metrics(speed=f"{speed} m/s")
    assert found["upright.fell"] == 0
    assert 0.6 < found["apex_speed"] / speed < 0.8
    again = metrics(speed=f"{speed} m/s", **{"simulate.duration": "15 s"})
    assert found["apex_speed"] == pytest.approx(again["apex_speed"], abs=1e-3)


def test_thrust_gives_what_the_damper_takes_and_the_spring_keeps(tmp_path: Path) -> None:
    """Over the last hop of a steady run."""
    out = tmp_path / "hop.csv"
    runs = gaitsim.run(SPEC, {"speed": "1 m/s"}, out=out, save=False)
    names = [head.split(" [")[0] for head in out.read_text(encoding="utf-8").split("\n", 1)[0].split(",")]
    rows = dict(zip(names, np.loadtxt(out, delimiter=",", skiprows=1, unpack=True), strict=True))
    speed = rows["guide.upward_velocity"]
    passages = np.flatnonzero((speed[:-1] > 0) & (speed[1:] <= 0))
    hop = slice(passages[-2], passages[-1])
    work = rows["thrust_control.work"][passages[-1]] - rows["thrust_control.work"][passages[-2]]
    damped = np.sum(DAMPING * rows["leg.velocity"][hop] ** 2) * 1e-3
    moment = rows["attitude_control.moment"][hop]
    turned = np.sum(moment * rows["guide.pitch_velocity"][hop]) * 1e-3
    length, across = rows["leg.length"][hop], rows["leg.ahead"][hop]
    turning = (rows["leg.above"][hop] * rows["guide.forward_velocity"][hop] - across * speed[hop]) / length**2
    turned -= np.sum(moment * turning) * 1e-3
    left = rows["leg.energy"][hop][rows["leg.in_stance"][hop] > 0.5][-1]  # where the damper ends the force
    assert work > 9 and work + turned == pytest.approx(damped + left, rel=0.01)
    assert runs.outcomes[0].metrics["upright.fell"] == 0


def test_it_recovers_from_a_lean() -> None:
    found = metrics(speed="0 m/s", initial_apex_pitch="10 deg")
    assert found["apex_pitch.first"] != pytest.approx(0, abs=1e-3) and abs(found["apex_pitch"]) < 1e-6


def test_its_gait_is_stable_at_rest_and_at_speed() -> None:
    for speed in ("0 m/s", "1 m/s"):
        found = gaitsim.cycle(SPEC, {"speed": speed, "initial_apex_height": "0.8 m"})
        assert found.stable and len(found.eigenvalues) == 5 and found.distance < 1e-9
