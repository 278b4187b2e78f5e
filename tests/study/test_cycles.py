"""Periodic gaits against closed forms, published values and independent integrations of the classical models."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest

import gaitsim
from gaitsim.errors import GaitsimError, SimulationFailed, Usage
from gaitsim.study.cycles import Cycle

SPECS = Path(__file__).parents[2] / "specs"


def gait(spec: str, **settings: Any) -> Cycle:
    return gaitsim.cycle(SPECS / f"{spec}.yaml", {name.replace("__", "."): each for name, each in settings.items()})


@pytest.mark.parametrize(
    ("angle", "start", "apex", "slope", "contact", "force"),
    [
        ("67 deg", "0.95 m", 0.95956871, 0.44141, 0.15805, 2641.9),
        ("67 deg", "1.2 m", 1.21435791, 1.43723, None, None),
        ("68 deg", "0.95 m", 0.94026714, -0.16131, 0.14924, 2086.9),
        ("68 deg", "1.33 m", 1.33768638, 1.68697, None, None),
    ],
)
def test_running(angle: str, start: str, apex: float, slope: float, contact: float | None, force: float | None) -> None:
    found = gait("running_slip", leg__touchdown_angle=angle, initial_apex_height=start)
    assert found.start["initial_apex_height"] == pytest.approx(apex, abs=1e-8)
    assert found.eigenvalues == (pytest.approx(slope, abs=6e-6),)
    assert found.stable == (abs(slope) < 1)
    if contact and force:
        assert found.metrics["contact_time"] == pytest.approx(contact, abs=6e-6)
        assert found.metrics["peak_force"] == pytest.approx(force, abs=0.06)


def test_walking_on_springs() -> None:
    found = gait("walking_slip")
    assert found.start["initial_height"] == pytest.approx(0.971160, abs=1e-6)
    assert found.start["initial_upward_velocity"] == pytest.approx(0, abs=1e-9)
    assert found.metrics["forward_velocity"] == pytest.approx(1.097909, abs=1e-6)
    assert found.eigenvalues[0] == pytest.approx(complex(0.804951942, 0.546264486), abs=1e-6)
    assert found.period == pytest.approx(0.444024, abs=1e-6)
    assert found.metrics["double_support"] == pytest.approx(0.166904, abs=1e-6)
    assert found.metrics["step_length"] == pytest.approx(0.513845, abs=1e-6)
    assert found.metrics["step_length"] / found.period == pytest.approx(1.157244, abs=2e-6)


def test_an_asymmetric_walk_on_springs_is_unstable() -> None:
    found = gait("walking_slip", initial_height="0.9676 m", initial_upward_velocity="-0.238 m/s")
    assert found.start["initial_height"] == pytest.approx(0.967596, abs=1e-6)
    assert found.start["initial_upward_velocity"] == pytest.approx(-0.238226, abs=1e-6)
    assert [abs(each) for each in found.eigenvalues] == pytest.approx([1.42, 0.53], abs=0.005)
    assert not found.stable


LONG = {"initial_half_angle": "0.2367 rad", "initial_stance_rate": "0.2315 rad/s", "initial_swing_rate": "0.206 rad/s"}
SHORT = {"initial_half_angle": "0.194 rad", "initial_stance_rate": "0.204 rad/s", "initial_swing_rate": "0.189 rad/s"}


@pytest.mark.parametrize(
    ("slope", "start", "half", "stance", "inter", "period", "eigenvalues"),
    [
        (0.009, {}, 0.2003109005, 0.1998324730, -0.01582300, 3.88246375, [-0.190099639 + 0.557599274j]),
        (0.009, SHORT, 0.1939373698, 0.2038669274, -0.01514426, 3.09610587, [4.00386, 0.45959]),
        (0.015, LONG, 0.2367121850, 0.2315461312, -0.02546725, 3.91200394, [-0.98046, -0.30420]),
    ],
)
def test_the_simplest_walker(
    slope: float,
    start: dict[str, str],
    half: float,
    stance: float,
    inter: float,
    period: float,
    eigenvalues: list[complex],
) -> None:
    """Garcia et al. (1998); eigenvalues of the first row to nine digits after Bhounsule (2014)."""
    found = gait("walking_simplest", slope=f"{slope} rad", **start)
    assert found.start["initial_half_angle"] == pytest.approx(half, abs=1e-8)
    assert found.start["initial_stance_rate"] == pytest.approx(stance, abs=1e-8)
    swing = found.start["initial_swing_rate"] - found.start["initial_stance_rate"]
    assert swing == pytest.approx(inter, abs=1e-7)
    assert found.period == pytest.approx(period, abs=1e-6)
    assert found.eigenvalues[: len(eigenvalues)] == pytest.approx(eigenvalues, abs=1e-5)


@pytest.mark.parametrize(
    ("slope", "half", "stance", "swing", "period", "length", "speed", "eigenvalue"),
    [
        ("3 deg", 0.27102868, 1.09238359, 0.37737395, 0.734346, 0.535445, 0.729146, 0.57995),
        ("4.3 deg", 0.30637365, 1.15017032, 0.16635905, 0.752301, 0.603206, 0.801815, 0.90288),
    ],
)
def test_the_compass_gait(
    slope: str, half: float, stance: float, swing: float, period: float, length: float, speed: float, eigenvalue: float
) -> None:
    found = gait("walking_compass", slope=slope)
    names = ("initial_half_angle", "initial_stance_rate", "initial_swing_rate")
    assert [found.start[name] for name in names] == pytest.approx([half, stance, swing], abs=3e-8)
    assert found.period == pytest.approx(period, abs=1e-6)
    assert found.metrics["step_length"] == pytest.approx(length, abs=1e-6)
    assert found.metrics["speed"] == pytest.approx(speed, abs=1e-6)
    assert abs(found.eigenvalues[0]) == pytest.approx(eigenvalue, abs=6e-6)


@pytest.mark.parametrize(("spokes", "slope", "inertia"), [(8, 0.08, 0.0), (12, 0.04, 0.0), (10, 0.06, 0.3)])
def test_the_rimless_wheel_has_its_closed_form(spokes: int, slope: float, inertia: float) -> None:
    """McGeer (1990): what a step gains of gravity is what its impact loses."""
    found = gait("rimless_wheel", spokes=spokes, slope=f"{slope} rad", inertia=f"{inertia} kg m^2")
    half, about = math.pi / spokes, inertia + 1
    kept = (inertia + math.cos(2 * half)) / about
    gained = 4 * 9.81 / about * math.sin(slope) * math.sin(half)
    rate = kept * math.sqrt(gained / (1 - kept**2))
    assert found.start["initial_rate"] == pytest.approx(rate, rel=1e-9)
    assert found.metrics["rate_before"] == pytest.approx(rate / kept, rel=1e-9)
    assert found.eigenvalues == (pytest.approx(kept**2, abs=1e-7),)
    assert found.metrics["speed"] * found.period == pytest.approx(2 * math.sin(half), rel=1e-9)


def test_a_wheel_that_does_not_roll_has_no_gait() -> None:
    with pytest.raises(SimulationFailed, match=r"from initial_rate = 0\.5 there is no return to the section: the run"):
        gait("rimless_wheel", initial_rate="0.5 rad/s")


def test_a_spec_without_sections_is_told_what_it_lacks() -> None:
    rule = (
        "has no parameter initial_NAME with a measure NAME of measure/section, between which a gait could be followed"
    )
    with pytest.raises(Usage, match=rule):
        gait("hopping_geyer2003")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("speed", "first", "last"),
    [(3.0, 0, 0), (3.5, 71.0, 71.0), (4.0, 69.5, 70.5), (5.0, 66.5, 68.5), (6.0, 63.5, 67.0)],
)
def test_running_is_stable_in_a_window_of_angles(speed: float, first: float, last: float) -> None:
    """At both ends of the window and not half a degree outside; at 3 m/s nowhere."""

    def stable(angle: float) -> bool:
        settings = {"leg.touchdown_angle": f"{angle} deg", "reference_speed": f"{speed} m/s"}
        for height in ("0.95 m", "0.92 m", "1 m"):
            try:
                if gaitsim.cycle(SPECS / "running_slip.yaml", {**settings, "initial_apex_height": height}).stable:
                    return True
            except GaitsimError:
                continue
        return False

    if not first:
        assert not any(stable(angle) for angle in (70.0, 71.0, 72.0, 73.0))
        return
    assert [stable(angle) for angle in (first - 0.5, first, last, last + 0.5)] == [False, True, True, False]
