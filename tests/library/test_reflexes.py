"""Every reflex of Geyer & Herr (2010) on plain arrays, alone and all together."""

from __future__ import annotations

import math

import numpy as np
import pytest
from components.calls import computed

from gaitsim.simulation.run import Mode

modes = pytest.mark.parametrize("mode", ["rapid", "normal"])


@modes
@pytest.mark.parametrize(
    ("kind", "gain", "offset", "signal", "stimulation"),
    [
        ("force", 1.2, 0.0, 0.5, 0.01 + 1.2 * 0.5),
        ("length", 1.1, 0.71, 0.95, 0.01 + 1.1 * 0.24),
        ("length", 1.1, 0.71, 0.6, 0.01 - 1.1 * 0.11),
        ("velocity", 0.5, 0.1, -0.3, 0.5 * -0.4),
    ],
)
def test_muscle_reflexes(kind: str, gain: float, offset: float, signal: float, stimulation: float, mode: Mode) -> None:
    values = {"gain": gain, "offset": offset, "signal": signal}
    found = computed(f"controller/{kind}_reflex", mode, **values).stimulation
    assert found == pytest.approx(stimulation, rel=1e-12)
    assert computed(f"controller/{kind}_reflex", mode, gate=0.0, **values).stimulation == 0


@modes
@pytest.mark.parametrize("kind", ["force", "length", "velocity"])
@pytest.mark.parametrize(("signal", "stimulation"), [(-5.0, 0.0), (0.5, 0.5), (5.0, 0.8)])
def test_muscle_reflexes_are_clamped_before_the_gate(kind: str, signal: float, stimulation: float, mode: Mode) -> None:
    values = {"gain": 1.0, "offset": 0.0, "bias": 0.0, "lower": 0.0, "upper": 0.8, "signal": signal}
    assert computed(f"controller/{kind}_reflex", mode, **values).stimulation == pytest.approx(stimulation)
    half = computed(f"controller/{kind}_reflex", mode, gate=0.5, **values).stimulation
    assert half == pytest.approx(0.5 * stimulation)


@modes
def test_a_negative_gain_turns_a_reflex_into_its_opposite(mode: Mode) -> None:
    values = {"gain": -2.0, "bias": 0.0, "signal": 0.3}
    assert computed("controller/force_reflex", mode, **values).stimulation == pytest.approx(-0.6)


@modes
@pytest.mark.parametrize(
    ("gain", "offset", "least", "signal", "stimulation"),
    [
        (0.3, 0.0, -1e6, 0.5, -0.15),  # soleus on tibialis anterior
        (4.0, 0.85, -1e6, 0.95, -0.4),  # hamstrings on hip flexors
        (4.0, 0.85, -1e6, 0.75, 0.4),  # as published it may excite
        (4.0, 0.85, 0.0, 0.75, 0.0),
        (1.2, 0.0, -1e6, 0.4, -0.48),  # the other leg's load on the vasti
    ],
)
def test_inhibition(gain: float, offset: float, least: float, signal: float, stimulation: float, mode: Mode) -> None:
    values = {"gain": gain, "offset": offset, "least": least, "signal": signal}
    assert computed("controller/inhibition", mode, **values).stimulation == pytest.approx(stimulation)
    assert computed("controller/inhibition", mode, gate=0.0, **values).stimulation == 0


@modes
def test_prestimulation(mode: Mode) -> None:
    assert computed("controller/prestimulation", mode, level=-0.25).stimulation == -0.25
    assert computed("controller/prestimulation", mode, level=-0.25, gate=0.0).stimulation == 0


@modes
@pytest.mark.parametrize(
    ("degrees", "rate", "stimulation"),
    [
        (175, 0.1, -2 * math.radians(5)),
        (175, -0.1, 0.0),  # on its way back
        (175, 0.0, 0.0),
        (169, 3.0, 0.0),  # not there yet
    ],
)
def test_knee_overextension(degrees: float, rate: float, stimulation: float, mode: Mode) -> None:
    """k_phi = 2 /rad beyond 170 deg; the same knee with an angle of flexion needs direction = -1."""
    straight = math.pi
    common = {"gain": -2.0, "angular_velocity": rate}
    found = computed("controller/joint_reflex", mode, offset=math.radians(170), angle=math.radians(degrees), **common)
    assert found.stimulation == pytest.approx(stimulation, abs=1e-12)
    flexion = {"gain": -2.0, "direction": -1.0, "angular_velocity": -rate}
    flexion |= {"offset": math.radians(10), "angle": straight - math.radians(degrees)}
    assert computed("controller/joint_reflex", mode, **flexion).stimulation == pytest.approx(stimulation, abs=1e-12)


@modes
@pytest.mark.parametrize(("pitch", "rate"), [(0.2, 0.0), (0.0, 0.0), (0.105, 1.0), (0.15, -0.5)])
def test_trunk_balance(pitch: float, rate: float, mode: Mode) -> None:
    """Published gains are the defaults; the load's magnitude scales both outputs."""
    effort = 1.91 * (pitch - 0.105) + 0.25 * rate
    found = computed("controller/trunk_balance", mode, pitch=pitch, pitch_rate=rate, load=0.8)
    assert found.forward == pytest.approx(max(effort, 0) * 1.2 * 0.8, rel=1e-12)
    assert found.backward == pytest.approx(max(-effort, 0) * 1.2 * 0.8, rel=1e-12)
    gluteus = computed("controller/trunk_balance", mode, share=0.68, pitch=pitch, pitch_rate=rate, load=-0.8)
    effort = 0.68 * 1.91 * (pitch - 0.105) + 0.25 * rate
    assert gluteus.forward == pytest.approx(max(effort, 0) * 1.2 * 0.8, rel=1e-12)
    shut = computed("controller/trunk_balance", mode, pitch=pitch, pitch_rate=rate, load=0.8, gate=0.0)
    assert shut.forward == shut.backward == 0


@modes
def test_lean_at_take_off(mode: Mode) -> None:
    values = {"proportional": 1.15, "reference": 0.105, "angle": 0.2}
    assert computed("controller/angle_reflex", mode, **values).stimulation == pytest.approx(1.15 * 0.095)
    values |= {"derivative": 0.25, "angular_velocity": -0.4, "bias": 0.05}
    found = computed("controller/angle_reflex", mode, **values).stimulation
    assert found == pytest.approx(0.05 + 1.15 * 0.095 - 0.1)
    assert computed("controller/angle_reflex", mode, upper=0.02, **values).stimulation == pytest.approx(0.02)
    assert computed("controller/angle_reflex", mode, gate=0.0, **values).stimulation == 0


def appendix(signals: dict[str, float], stance: float, double: float) -> dict[str, float]:
    """Appendix I of Geyer & Herr (2010) as one piece, with the published gains."""
    force = {m: signals[f"force_{m}"] for m in ("sol", "gas", "vas", "ham", "glu")}
    length = {m: signals[f"length_{m}"] for m in ("ta", "hfl", "ham")}
    knee, knee_rate = signals["knee"], signals["knee_rate"]
    lean, rate, own, other = (signals[n] for n in ("lean", "rate", "own", "other"))
    balance = 1.91 * (lean - 0.105) + 0.25 * rate
    gluteus = 0.68 * 1.91 * (lean - 0.105) + 0.25 * rate
    tibialis = 0.01 + 1.1 * (length["ta"] - 0.71)
    if not stance:
        hip = 0.35 * (length["hfl"] - 0.6) - 4 * (length["ham"] - 0.85) + 1.15 * (signals["takeoff_lean"] - 0.105)
        return {
            "sol": 0.0,
            "gas": 0.0,
            "vas": 0.0,
            "ta": tibialis,
            "hfl": 0.01 + hip,
            "ham": 0.01 + 0.65 * force["ham"],
            "glu": 0.01 + 0.4 * force["glu"],
        }
    beyond = 2 * (knee - 2.97) if knee > 2.97 and knee_rate > 0 else 0.0
    return {
        "sol": 0.01 + 1.2 * force["sol"],
        "gas": 0.01 + 1.1 * force["gas"],
        "vas": 0.09 + 1.15 * force["vas"] - beyond - 1.2 * other * double,
        "ta": tibialis - 0.3 * force["sol"],
        "ham": 0.05 + max(balance, 0) * 1.2 * own,
        "glu": 0.05 + max(gluteus, 0) * 1.2 * own - 0.25 * double,
        "hfl": 0.05 + max(-balance, 0) * 1.2 * own + 0.25 * double,
    }


def by_parts(signals: dict[str, float], stance: float, double: float) -> dict[str, float]:
    """The same sums from the library's parts."""
    swing = 1 - stance

    def force(muscle: str, gain: float, gate: float, bias: float = 0.01) -> float:
        values = {"gain": gain, "signal": signals[f"force_{muscle}"], "gate": gate, "bias": bias}
        return float(computed("controller/force_reflex", **values).stimulation)

    def length(muscle: str, gain: float, offset: float, gate: float) -> float:
        values = {"gain": gain, "offset": offset, "signal": signals[f"length_{muscle}"], "gate": gate}
        return float(computed("controller/length_reflex", **values).stimulation)

    def less(gain: float, signal: float, gate: float, offset: float = 0) -> float:
        values = {"gain": gain, "signal": signal, "gate": gate, "offset": offset}
        return float(computed("controller/inhibition", **values).stimulation)

    def tonic(level: float, gate: float) -> float:
        return float(computed("controller/prestimulation", level=level, gate=gate).stimulation)

    trunk = {"pitch": signals["lean"], "pitch_rate": signals["rate"], "load": signals["own"], "gate": stance}
    balance = computed("controller/trunk_balance", **trunk)
    gluteus = computed("controller/trunk_balance", share=0.68, **trunk)
    knee = {"angle": signals["knee"], "angular_velocity": signals["knee_rate"], "gate": stance}
    stretch = computed("controller/joint_reflex", gain=-2, offset=2.97, **knee).stimulation
    lean = {"proportional": 1.15, "reference": 0.105, "angle": signals["takeoff_lean"], "gate": swing}
    return {
        "sol": force("sol", 1.2, stance),
        "gas": force("gas", 1.1, stance),
        "vas": force("vas", 1.15, stance, bias=0.09) + stretch + less(1.2, signals["other"], double),
        "ta": length("ta", 1.1, 0.71, 1) + less(0.3, signals["force_sol"], stance),
        "ham": tonic(0.05, stance) + balance.forward + force("ham", 0.65, swing),
        "glu": tonic(0.05, stance) + gluteus.forward + tonic(-0.25, double) + force("glu", 0.4, swing),
        "hfl": tonic(0.05, stance)
        + balance.backward
        + tonic(0.25, double)
        + length("hfl", 0.35, 0.6, swing)
        + less(4, signals["length_ham"], swing, offset=0.85)
        + computed("controller/angle_reflex", **lean).stimulation,
    }


@pytest.mark.parametrize(("stance", "double"), [(1.0, 0.0), (1.0, 1.0), (0.0, 0.0)])
def test_all_reflexes_sum_to_the_appendix(stance: float, double: float) -> None:
    chance = np.random.default_rng(5)
    for _ in range(50):
        signals = {f"force_{m}": chance.uniform(0, 1) for m in ("sol", "gas", "vas", "ham", "glu")}
        signals |= {f"length_{m}": chance.uniform(0.4, 1.3) for m in ("ta", "hfl", "ham")}
        signals |= {"knee": chance.uniform(2.8, 3.1), "knee_rate": chance.uniform(-2, 2)}
        signals |= {"lean": chance.uniform(-0.3, 0.4), "rate": chance.uniform(-2, 2)}
        signals |= {"own": chance.uniform(0, 1.3), "other": chance.uniform(0, 1.3)}
        signals |= {"takeoff_lean": chance.uniform(-0.2, 0.3)}
        wanted, found = appendix(signals, stance, double), by_parts(signals, stance, double)
        assert found == pytest.approx(wanted, rel=1e-12, abs=1e-12)


@pytest.mark.parametrize("length", [0.5, 0.85, 1.1])
def test_a_stretch_below_its_offset_is_no_stretch(length: float) -> None:
    """As in the author's release: {l - l_off}+, for a muscle's own reflex and for the one that it inhibits."""
    stretch = max(0.0, length - 0.85)
    values = {"gain": 4, "offset": 0.85, "least": 0, "signal": length}
    assert computed("controller/length_reflex", **values).stimulation == pytest.approx(0.01 + 4 * stretch)
    assert computed("controller/inhibition", **values).stimulation == pytest.approx(-4 * stretch)
