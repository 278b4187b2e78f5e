"""Metabolic power in reference states computed independently, and the cost of transport."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from components.calls import computed, metrics

from gaitsim.components.find import Library, library_folders
from gaitsim.model import Model
from gaitsim.simulation.run import Simulator
from gaitsim.spec.resolve import read_spec, resolve

from .muscle_rig import MUSCLES

modes = pytest.mark.parametrize("mode", ["rapid", "normal"])
MASS = 0.423880
SIZES = {"max_isometric_force": 1000.0, "optimal_fiber_length": 0.1, "max_contraction_velocity": 10.0}
# u, a, l in l_opt, v in v_max, F_CE in N; then W/kg and W computed independently from the published equations.
STATES: list[tuple[tuple[float, float, float, float, float], dict[str, float]]] = [
    (
        (1, 1, 1, 0, 1000),
        {"h_AM": 133.5, "h_SL": 0, "w": 0, "E": 133.5, "umberger2003": 56.588, "umberger2010": 56.588, "wang": 75.8745},
    ),
    (
        (1, 1, 1, -0.3, 280),
        {
            "h_AM": 133.5,
            "h_SL": 90.675,
            "w": 198.1693,
            "E": 422.3443,
            "umberger2003": 179.0233,
            "umberger2010": 179.0233,
            "wang": 180.8745,
        },
    ),
    (
        (0.5, 0.5, 1, 0, 500),
        {
            "h_AM": 88.0772,
            "h_SL": 0,
            "w": 0,
            "E": 88.0772,
            "umberger2003": 37.3341,
            "umberger2010": 37.3341,
            "wang": 32.2310,
        },
    ),
    (
        (0.5, 0.5, 1.2, 0.3, 641.954),
        {
            "h_AM": 81.3358,
            "h_SL": 196.2978,
            "w": -454.3411,
            "E": -176.7074,
            "umberger2003": -74.9027,
            "umberger2010": 40.7171,
            "wang": 25.0389,
        },
    ),
    (
        (0.01, 0.01, 1, 0, 10),
        {
            "h_AM": 8.4233,
            "h_SL": 0,
            "w": 0,
            "E": 8.4233,
            "umberger2003": 3.5705,
            "umberger2010": 3.5705,
            "wang": 0.3859,
        },
    ),
]
every_state = pytest.mark.parametrize(("state", "known"), STATES)


def force_length(length: float) -> float:
    return math.exp(math.log(0.05) * (abs(length - 1) / 0.56) ** 3)


def power(reference: str, state: tuple[float, float, float, float, float], mode: str = "rapid", **more: float) -> Any:
    u, a, length, velocity, force = state
    signals = {
        "excitation": u,
        "activation": a,
        "normalized_fiber_length": length,
        "fiber_velocity": velocity * 10 * 0.1,
        "fiber_force": force,
        "force": force,
        "normalized_isometric_force": force_length(length),
    }
    return computed(f"metabolics/{reference}", mode, **(SIZES | signals | more))


@modes
@every_state
def test_umberger2003(state: Any, known: dict[str, float], mode: str) -> None:
    now = power("umberger2003", state, mode)
    assert now.power == pytest.approx(known["umberger2003"], abs=5e-4)
    assert now.power / MASS == pytest.approx(known["E"], abs=2e-3)
    assert now.heat / MASS == pytest.approx(known["h_AM"] + known["h_SL"], abs=1e-3)
    assert now.work / MASS == pytest.approx(known["w"], abs=2e-3)


@modes
@every_state
def test_umberger2010(state: Any, known: dict[str, float], mode: str) -> None:
    now = power("umberger2010", state, mode)
    assert now.power == pytest.approx(known["umberger2010"], abs=5e-4)
    assert now.work >= 0


@modes
@every_state
def test_wang2012(state: Any, known: dict[str, float], mode: str) -> None:
    assert power("wang2012", state, mode).power == pytest.approx(known["wang"], abs=1e-3)


def test_the_parts_of_wang2012() -> None:
    now = power("wang2012", STATES[1][0])
    assert now.work == pytest.approx(84)
    assert now.heat - 0.25 * now.work == pytest.approx(36.6656 + 39.2089, abs=1e-3)


@modes
def test_uchida2016_recruits_slow_fibers_first_and_takes_up_no_power(mode: str) -> None:
    # Half excited: sin 45 deg against 1 - cos 45 deg; at most and at least excited by the limits.
    for u, slow in ((0.5, 0.70710678 / (0.70710678 + 0.29289322)), (1.0, 0.5), (0.0, 1.0)):
        now = power("uchida2016", (u, u, 1, 0, 0), mode, least_heat=0)
        assert now.power / MASS == pytest.approx(1.5 * u**0.6 * (128 * (1 - slow) + 25), abs=1e-3)
    lengthening = power("uchida2016", STATES[3][0], mode)
    assert lengthening.work < 0
    assert lengthening.power == 0
    assert lengthening.heat == pytest.approx(-lengthening.work)


@modes
def test_bhargava2004_by_hand(mode: str) -> None:
    quarter = math.pi / 4
    slow, fast = 0.5 * math.sin(quarter), 0.5 * (1 - math.cos(quarter))
    for length, reach in ((0.3, 0.5), (0.7, 0.7), (1.0, 1.0), (1.25, 0.5), (1.6, 0.0)):
        held = MASS * (40 * slow + 133 * fast + reach * (74 * slow + 111 * fast))
        now = power("bhargava2004", (0.5, 0.4, length, 0, 300), mode)
        assert now.power == pytest.approx(held, rel=1e-5)
        shortening = power("bhargava2004", (0.5, 0.4, length, -0.2, 300), mode)
        shares = 0.16 * 0.4 * 1000 * force_length(length) + 0.18 * 300
        assert shortening.power == pytest.approx(held + shares * 0.2 + 300 * 0.2, rel=1e-5)
        lengthening = power("bhargava2004", (0.5, 0.4, length, 0.01, 300), mode)
        assert lengthening.power == pytest.approx(held - 0.157 * 300 * 0.01 - 300 * 0.01, rel=1e-5)


@modes
def test_the_simpler_shortening_heat_of_bhargava2004_is_wangs(mode: str) -> None:
    simple = {"isometric_share": 0.0, "total_share": 0.25, "lengthening_share": 0.0}
    for state, _ in STATES[:3]:
        ours, other = power("bhargava2004", state, mode, **simple), power("wang2012", state, mode)
        assert ours.power == pytest.approx(other.power, rel=1e-9)


@modes
@pytest.mark.parametrize("reference", ["umberger2003", "umberger2010", "uchida2016", "bhargava2004"])
def test_heat_is_at_least_one_watt_a_kilogram(reference: str, mode: str) -> None:
    assert power(reference, (0, 0, 1, 0, 0), mode).power == pytest.approx(MASS, rel=1e-5)


@modes
@pytest.mark.parametrize("reference", ["umberger2003", "umberger2010", "uchida2016", "bhargava2004", "wang2012"])
def test_power_grows_with_what_asks_for_it(reference: str, mode: str) -> None:
    excited = [power(reference, (u, u, 1, -0.1, 500 * u), mode).power for u in np.linspace(0.05, 1, 20)]
    assert np.all(np.diff(excited) > 0)
    # A slower muscle of the same kind is cheaper to keep active.
    kept = [power(reference, (0.3, 0.3, 1, 0, 300), mode, slow_twitch=r).power for r in (0.0, 0.5, 1.0)]
    assert (kept[0] > kept[2]) == (reference in ("umberger2003", "umberger2010", "uchida2016"))


@pytest.mark.parametrize(
    ("force", "fiber", "mass"),
    [(4000, 0.04, 0.6782), (1500, 0.05, 0.3179), (800, 0.06, 0.2035), (6000, 0.08, 2.0346), (3000, 0.10, 1.2716)],
)
def test_masses_of_the_muscles_of_geyer_and_herr(force: float, fiber: float, mass: float) -> None:
    sizes = {"max_isometric_force": float(force), "optimal_fiber_length": fiber}
    assert power("umberger2003", (0, 0, 1, 0, 0), **sizes).power == pytest.approx(mass, abs=6e-5)


def test_cost_of_transport() -> None:
    # Two seconds do not count; then 3 m at 1.5 m/s with 160 W, of 80 kg.
    times = np.arange(401) * 0.01
    signals = {"position": 0.5 + 1.5 * times, "power": np.where(times > 2.005, 160.0, 999.0)}
    found = metrics("measure/cost_of_transport", signals, 0.01, mass=80.0)
    # The trapezoid of the first step counts half of what was before.
    assert found["muscles"] == pytest.approx((160 * 2 + 0.5 * 0.01 * 839) / (80 * 3), rel=1e-9)
    assert found["value"] == pytest.approx(found["muscles"] + 1.2 * 2 / 3, rel=1e-9)
    assert found["rate"] == pytest.approx(found["muscles"] * 1.5 + 1.2, rel=1e-9)


def test_no_cost_of_transport_without_a_way() -> None:
    still = {"position": [1.0] * 400, "power": [100.0] * 400}
    found = metrics("measure/cost_of_transport", still, 0.01, mass=80.0)
    assert math.isnan(found["value"]) and found["rate"] == pytest.approx(1.2 + 100 / 80)
    short = metrics("measure/cost_of_transport", {"position": [0.0, 1.0], "power": [1.0, 1.0]}, 0.01, mass=80.0)
    assert all(math.isnan(value) for value in short.values())


WALKER = """
gaitsim: 1
parts:
  thigh: {use: segment/rod, mass: 8 kg, length: 0.5 m}
  hip: {use: joint/geyer2010, parent: world, child: thigh.proximal, grows: backwards, neutral: 180 deg}
  gluteus:
    use: muscle/MUSCLE
    max_isometric_force: 1500 N
    optimal_fiber_length: 11 cm
    tendon_slack_length: 13 cm
    excitation: 0.3
    path: {use: path/constant_arm, joint: hip, moment_arm: 10 cm, reference_angle: 150 deg, pennation: 0.5}
    metabolics: {use: metabolics/umberger2003, to: {power: leg.powers}}
  leg: {use: sensor/metabolic_power, to: cost.power}
measures:
  cost: {use: measure/cost_of_transport, mass: 80 kg, settle: 0 s, position: 1 m}
use_for: {metabolics: metabolics/METABOLICS}
initial: {hip.angle: 160 deg}
simulate: {duration: 0.1 s, step: 0.1 ms}
"""


def made(folder: Path, muscle: str, metabolics: str = "umberger2003") -> Model:
    spec = folder / "spec.yaml"
    spec.write_text(WALKER.replace("MUSCLE", muscle).replace("METABOLICS", metabolics), encoding="utf-8")
    return resolve(read_spec(spec), Library(library_folders(spec)), "spec")


# Each muscle with one, and one muscle with each; the slow set has every pair.
PAIRS = [(muscle, metabolics) for metabolics in ("umberger2003", "bhargava2004", "wang2012") for muscle in MUSCLES]
FEW = ("umberger2003", "geyer2010")


@pytest.mark.parametrize(
    ("muscle", "metabolics"),
    [p if set(p) & set(FEW) else pytest.param(*p, marks=pytest.mark.slow) for p in PAIRS],
)
def test_every_muscle_has_metabolics_by_one_line(muscle: str, metabolics: str, tmp_path: Path) -> None:
    outcome = Simulator(made(tmp_path, muscle, metabolics)).run(recorded=True)
    found = outcome.trajectory
    assert found is not None
    power = found["gluteus.metabolics.power"]
    assert np.all(power > 0)
    assert found["leg.power"] == pytest.approx(power)
    last = np.trapezoid(power, found.times) / (found.times[-1] - found.times[0])
    assert outcome.metrics["cost.rate"] == pytest.approx(1.2 + last / 80, rel=1e-3)
    # What it works is what the fiber does.
    work = -found["gluteus.fiber_force"] * found["gluteus.fiber_velocity"]
    expected = np.maximum(work, 0) if metabolics == "wang2012" else work
    assert found["gluteus.metabolics.work"] == pytest.approx(expected, abs=1e-9)


def test_a_muscle_without_metabolics_has_none(tmp_path: Path) -> None:
    spec = tmp_path / "spec.yaml"
    lines = [line for line in WALKER.replace("MUSCLE", "geyer2010").splitlines() if "metabolics/" not in line]
    spec.write_text("\n".join(lines), encoding="utf-8")
    model = resolve(read_spec(spec), Library(library_folders(spec)), "spec")
    assert not [part for part in model.parts if part.type.kind == "metabolics"]
