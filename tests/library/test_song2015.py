"""The modules of Song & Geyer (2015): each part, and all together, against the equations of the released model."""

from __future__ import annotations

import math
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from components.calls import computed

from gaitsim.components.find import Library, library_folders
from gaitsim.simulation.run import Mode, Simulator
from gaitsim.spec.resolve import resolve
from gaitsim.text.document import parse

from .play import played

RIG = Path(__file__).parent / "rig"
modes = pytest.mark.parametrize("mode", ["rapid", "normal"])
MUSCLES = ("hip_flexor", "gluteus", "hamstrings", "rectus", "vastus", "biceps", "gastrocnemius", "soleus", "tibialis")
REFERENCE = math.radians(168.9)  # of the short head of the biceps femoris
UNITS = {"hip_flexor_lean": "1/rad", "gluteus_lean": "1/rad", "hip_flexor_lean_rate": "s/rad"}
UNITS |= {"gluteus_lean_rate": "s/rad", "lean": "rad", "brake_angle": "rad", "clearance": "m", "hold_biceps": "s^2"}
UNITS |= dict.fromkeys(("swing_hip_flexor_rate", "swing_gluteus_rate", "knee_flexion", "hold_rectus"), "s")
GAINS = (
    *(f"{phase}_bias_{muscle}" for phase in ("stance", "swing") for muscle in MUSCLES),
    *(
        "lean",
        "gluteus_force_gain",
        "vastus_force_gain",
        "soleus_force_gain",
        "hamstrings_force_gain",
        "biceps_vastus_offset",
    ),
    *("biceps_vastus_gain", "biceps_offset", "biceps_length_gain", "gastrocnemius_force_gain", "hip_flexor_lean"),
    *("hip_flexor_lean_rate", "gluteus_lean", "gluteus_lean_rate", "hamstrings_share", "opposite_gluteus_hip_flexor"),
    *("opposite_hamstrings_hip_flexor", "opposite_hip_flexor_gluteus", "opposite_rectus_gluteus"),
    *("tibialis_stance_offset", "tibialis_stance_length", "soleus_tibialis", "tibialis_swing_length"),
    *("tibialis_swing_offset", "brake_angle", "swing_hip_flexor", "swing_hip_flexor_rate", "swing_gluteus"),
    *("swing_gluteus_rate", "knee_flexion", "clearance", "hold_rectus", "hold_biceps", "stop_hamstrings"),
    *("stop_biceps", "stop_gastrocnemius", "stop_threshold", "prepare_hip_flexor", "prepare_gluteus"),
    *("prepare_vastus", "prepare_vastus_offset", "suppression", "transition"),
)
FELT = (
    *("load", "opposite_load", "opposite_hip_flexor", "opposite_gluteus", "opposite_rectus", "opposite_hamstrings"),
    *("hip_flexor_length", "gluteus_length", "gluteus_force", "hamstrings_length", "hamstrings_velocity"),
    *("hamstrings_force", "rectus_length", "rectus_velocity", "vastus_length", "vastus_velocity", "vastus_force"),
    *("biceps_length", "biceps_velocity", "gastrocnemius_force", "soleus_force", "tibialis_length"),
)


@modes
def test_the_target_of_the_leg(mode: Mode) -> None:
    """a_tgt = a_0 + c_d d + c_v v - theta forwards; sideways a trunk that leans outwards adds to it."""
    values = {
        "nominal": 1.1,
        "distance_gain": 0.4,
        "velocity_gain": 0.3,
        "distance": 0.2,
        "velocity": -0.5,
        "lean": 0.07,
    }
    found = computed("controller/leg_target", mode, **values)
    assert found.world_target == pytest.approx(1.1 + 0.4 * 0.2 - 0.3 * 0.5, rel=1e-12)
    assert found.target == pytest.approx(found.world_target - 0.07, rel=1e-12)
    sideways = computed("controller/leg_target", mode, lean_gain=1.0, **values)
    assert sideways.target == pytest.approx(found.world_target + 0.07, rel=1e-12)


@modes
@pytest.mark.parametrize(
    ("own", "other", "mismatch", "chosen"), [(1, 1, 0.8, 1), (1, 1, 1.2, 0), (1, 0, 0.1, 0), (0, 1, 0.1, 0)]
)
def test_the_leg_that_is_further_from_its_target_swings(
    own: float, other: float, mismatch: float, chosen: float, mode: Mode
) -> None:
    """|a - a_tgt| + |b - b_tgt| = |3.3 - 1.5 - 1.0| + |0.1 - 0.3| = 1.0."""
    values = {"hip_angle": 3.3, "knee_angle": 3.0, "target": 1.0, "abduction": 0.1, "abduction_target": 0.3}
    stands = {"in_stance": own, "opposite_in_stance": other}
    found = computed("controller/swing_choice", mode, opposite_mismatch=mismatch, **values, **stands)
    assert found.angle == pytest.approx(1.8) and found.mismatch == pytest.approx(1.0)
    assert found.initiation == chosen


@modes
@pytest.mark.parametrize(
    ("stands", "initiation", "support", "beginning"), [(1, 0, 1, 0), (1, 1, 1 - 3 * 0.5, 1.5 * 0.5), (0, 0, 0, 0)]
)
def test_gates(stands: float, initiation: float, support: float, beginning: float, mode: Mode) -> None:
    values = {"suppression": 3.0, "transition": 1.5, "opposite_load": 0.5}
    found = computed("controller/song2015_gates", mode, in_stance=stands, initiation=initiation, **values)
    assert found.support == pytest.approx(support) and found.beginning == pytest.approx(beginning)
    assert found.swing == 1 - stands and found.swing_and_beginning == pytest.approx(1 - stands + beginning)


@modes
def test_the_phases_of_swing_follow_one_another_and_are_forgotten_in_stance(mode: Mode) -> None:
    """Stance, its end, five steps of swing and stance again; a phase begins one step after what decides it."""
    signals = {
        "in_stance": [1, 1, 0, 0, 0, 0, 0, 0, 1, 1],
        "initiation": [0, 1, 0, 0, 0, 0, 0, 0, 0, 0],
        "biceps_length": [0.5, 0.5, 1.1, 0.8, 1.1, 1.1, 1.1, 1.1, 1.1, 1.1],
        "rectus_length": [0.5, 0.5, 1.0, 1.0, 1.0, 0.9, 1.0, 1.0, 1.0, 1.0],
        "hamstrings_length": [1.5, 1.5, 1.0, 1.0, 1.2, 1.2, 1.2, 1.0, 1.0, 1.0],
        "hamstrings_velocity": [0.0, 0.0, 0.1, 0.1, 0.1, 0.1, -0.1, 0.1, 0.1, 0.1],
    }
    level = {"rectus_target": [0.95] * 10, "hamstrings_target": [1.1] * 10}
    knee = REFERENCE + (0.85 - 1) / 0.1988
    clearance = 2 * 0.46 * math.sin(knee / 2)
    found = played(
        "controller/song2015_swing_phases",
        {**signals, **level},
        mode,
        clearance=clearance,
        slope=0.1988,
        reference=REFERENCE,
    )
    assert found["flexion"] == [0, 0, 1, 1, 0, 0, 0, 0, 0, 0]
    assert found["hold"] == [0, 0, 0, 0, 1, 1, 0, 0, 0, 0]
    assert found["stop"] == [0, 0, 0, 0, 0, 1, 1, 1, 0, 0]
    assert found["preparation"] == [0, 0, 0, 0, 0, 0, 0, 1, 0, 0]


@modes
def test_a_clearance_beyond_the_straight_leg_ends_flexion_at_once(mode: Mode) -> None:
    names = ("biceps_length", "rectus_length", "rectus_target", "hamstrings_length", "hamstrings_target")
    signals = {name: [1.0] * 3 for name in (*names, "hamstrings_velocity")} | {"initiation": [0.0] * 3}
    values = {"clearance": 15.0, "slope": 0.1988, "reference": REFERENCE}
    found = played("controller/song2015_swing_phases", {**signals, "in_stance": [1, 0, 0]}, mode, **values)
    assert found["flexion"] == [0, 1, 0] and found["hold"] == [0, 0, 0]


@modes
def test_a_signal_follows_another_with_its_time_constant(mode: Mode) -> None:
    found = played("sensor/low_pass", {"signal": [2.0, 5.0, 5.0, 5.0]}, mode, dt=0.01, time_constant=0.02)
    expected = [2.0] + [5 - 3 * math.exp(-0.5 * steps) for steps in (0, 1, 2)]
    assert found["filtered"] == pytest.approx(expected, rel=1e-12)


@modes
@pytest.mark.parametrize("side", [1, -1])
def test_motion_over_the_other_place_along_the_heading(side: float, mode: Mode) -> None:
    values = {"x": 1.2, "y": 0.5, "origin_x": 1.0, "origin_y": 0.2, "x_velocity": 1.3, "y_velocity": -0.4}
    found = computed("sensor/relative_motion", mode, heading=0.3, side=side, **values)
    turn = np.array([[math.cos(0.3), math.sin(0.3)], [-math.sin(0.3), math.cos(0.3)]])
    assert [found.forward, side * found.medial] == pytest.approx(list(turn @ [0.2, 0.3]), rel=1e-12)
    assert [found.forward_velocity, side * found.medial_velocity] == pytest.approx(list(turn @ [1.3, -0.4]), rel=1e-12)


def positive(value: float) -> float:
    return max(0.0, value)


def excitations(p: SimpleNamespace, s: SimpleNamespace, gate: SimpleNamespace) -> dict[str, float]:
    """The sums of the released model. Slopes and reference angles are its numbers; velocities become l_opt/s."""
    deg = math.radians
    v = {name: 12 * getattr(s, f"{name}_velocity") for name in ("hamstrings", "rectus", "vastus", "biceps")}
    rf = 1 + 0.24 * (s.target - deg(135.5))
    ham = 1 - 0.3271 * (s.target + p.brake_angle - deg(43.4))
    support = gate.stands * (1 - gate.initiation * p.suppression * s.opposite_load)
    swing, begun = 1 - gate.stands, gate.initiation * p.transition * s.opposite_load
    u = {m: gate.stands * getattr(p, f"stance_bias_{m}") + swing * getattr(p, f"swing_bias_{m}") for m in MUSCLES}
    # M1 and M2
    u["gluteus"] += support * p.gluteus_force_gain * s.gluteus_force
    u["vastus"] += support * p.vastus_force_gain * s.vastus_force
    u["soleus"] += gate.stands * p.soleus_force_gain * s.soleus_force
    u["hamstrings"] += support * p.hamstrings_force_gain * s.hamstrings_force
    u["vastus"] -= support * p.biceps_vastus_gain * positive(s.biceps_length - p.biceps_vastus_offset)
    u["biceps"] += support * p.biceps_length_gain * positive(s.biceps_length - p.biceps_offset)
    u["gastrocnemius"] += gate.stands * p.gastrocnemius_force_gain * s.gastrocnemius_force
    # M3
    bears, lean = gate.stands * s.load, s.pitch - p.lean
    u["hip_flexor"] += bears * positive(-p.hip_flexor_lean * lean - p.hip_flexor_lean_rate * s.pitch_rate)
    upright = p.gluteus_lean * lean + p.gluteus_lean_rate * s.pitch_rate
    u["gluteus"] += bears * positive(upright)
    u["hamstrings"] += bears * positive(p.hamstrings_share * upright)
    # M4
    other = 1 - gate.opposite_stands
    flexes = (
        p.opposite_gluteus_hip_flexor * s.opposite_gluteus + p.opposite_hamstrings_hip_flexor * s.opposite_hamstrings
    )
    extends = p.opposite_hip_flexor_gluteus * s.opposite_hip_flexor + p.opposite_rectus_gluteus * s.opposite_rectus
    u["hip_flexor"] += other * flexes
    u["gluteus"] += other * extends
    u["hamstrings"] += other * p.hamstrings_share * extends
    # M5
    stance_length = p.tibialis_stance_length * positive(s.tibialis_length - p.tibialis_stance_offset)
    u["tibialis"] += gate.stands * (stance_length - p.soleus_tibialis * s.soleus_force)
    u["tibialis"] += swing * p.tibialis_swing_length * positive(s.tibialis_length - p.tibialis_swing_offset)
    # M6
    swings = swing + begun
    m6_flexor = p.swing_hip_flexor * positive(s.rectus_length - rf) + p.swing_hip_flexor_rate * min(0.0, v["rectus"])
    m6_gluteus = p.swing_gluteus * positive(s.hamstrings_length - ham)
    m6_gluteus += p.swing_gluteus_rate * min(0.0, v["hamstrings"])
    # M7 and M8
    u["biceps"] -= (swing * gate.flexion + begun) * p.knee_flexion * min(0.0, v["rectus"])
    u["rectus"] += gate.hold * p.hold_rectus * positive(v["vastus"])
    turn = positive(v["biceps"] / 0.1988 + v["rectus"] / 0.24) * positive((s.rectus_length - rf) / 0.24)
    u["biceps"] += gate.hold * p.hold_biceps * positive(v["biceps"]) * turn
    # M9
    stop = p.stop_hamstrings * positive(s.hamstrings_length - ham)
    u["hamstrings"] += gate.stop * stop
    u["biceps"] += gate.stop * p.stop_biceps * positive(stop - p.stop_threshold)
    u["gastrocnemius"] += gate.stop * p.stop_gastrocnemius * positive(stop - p.stop_threshold)
    # M10
    straight = math.pi / 2 + s.target
    m10_flexor = p.prepare_hip_flexor * positive(s.hip_flexor_length - (1 + 0.3653 * (straight - deg(162.7))))
    m10_gluteus = p.prepare_gluteus * positive(s.gluteus_length - (1 - 0.3625 * (straight - deg(118.5))))
    u["vastus"] += gate.preparation * p.prepare_vastus * positive(s.vastus_length - p.prepare_vastus_offset)
    u["hip_flexor"] += swings * m6_flexor + gate.preparation * m10_flexor
    u["gluteus"] += swings * m6_gluteus + gate.preparation * m10_gluteus
    sums = {
        "hip_flexor_swing": swings * m6_flexor + gate.preparation * m10_flexor,
        "gluteus_swing": swings * m6_gluteus + gate.preparation * m10_gluteus,
        "rectus_swing": gate.hold * p.hold_rectus * positive(v["vastus"]),
        "hamstrings_swing": gate.stop * stop,
    }
    return {f"{muscle}_excitation": value for muscle, value in u.items()} | sums


OUTPUTS = {f"{muscle}_excitation": f"{muscle}_neurons.excitation" for muscle in MUSCLES} | {
    "hip_flexor_swing": "hip_flexor_swing_sum.excitation",
    "gluteus_swing": "gluteus_swing_sum.excitation",
    "rectus_swing": "hold.rectus",
    "hamstrings_swing": "stop.hamstrings",
}


def composed(
    reference: str, held: dict[str, tuple[str, str, float]], values: dict[str, str], mode: Mode
) -> dict[str, float]:
    """What goes on in a composite after two steps of held signals, in which phases of swing come and stay."""
    text = "gaitsim: 1\nparts:\n"
    for name, (kind, unit, value) in held.items():
        text += f"  a_{name}: {{use: sensor/held, {kind}: {value!r}{unit}}}\n"
    text += f"  reflexes:\n    use: {reference}\n"
    text += "".join(f"    {name}: {{from: a_{name}.held_{kind}}}\n" for name, (kind, _, _) in held.items())
    text += "".join(f"    {name}: {value}\n" for name, value in values.items())
    text += "simulate: {duration: 1.5 ms, step: 0.5 ms}\n"
    library = Library([RIG / "components", *library_folders(RIG)])
    outcome = Simulator(resolve(parse(text, "song.yaml"), library, "song"), mode).run(recorded=True)
    assert outcome.trajectory is not None, outcome.reason
    return {name: float(outcome.trajectory[name][-1]) for name in outcome.trajectory.signals}


def ran(p: SimpleNamespace, s: SimpleNamespace, gate: SimpleNamespace, mode: Mode) -> dict[str, float]:
    """What the sagittal modules send."""
    held = {name: ("number", "", getattr(s, name)) for name in FELT}
    held |= {"in_stance": ("number", "", gate.stands), "opposite_in_stance": ("number", "", gate.opposite_stands)}
    held |= {"initiation": ("number", "", gate.initiation), "target": ("angle", " rad", s.target)}
    held |= {"pitch": ("angle", " rad", s.pitch), "pitch_rate": ("rate", " rad/s", s.pitch_rate)}
    values = {name: f"{getattr(p, name)!r} {UNITS.get(name, '')}" for name in GAINS}
    found = composed("controller/song2015", held, values, mode)
    return {name: found[f"reflexes.{port}"] for name, port in OUTPUTS.items()}


CASES = {
    "support": {"stands": 1.0, "opposite_stands": 1.0, "initiation": 0.0},
    "alone": {"stands": 1.0, "opposite_stands": 0.0, "initiation": 0.0},
    "beginning": {"stands": 1.0, "opposite_stands": 1.0, "initiation": 1.0},
    "flexion": {"stands": 0.0, "opposite_stands": 1.0, "initiation": 0.0, "flexion": 1.0},
    "hold": {"stands": 0.0, "opposite_stands": 1.0, "initiation": 0.0, "hold": 1.0},
    "stop": {"stands": 0.0, "opposite_stands": 1.0, "initiation": 0.0, "hold": 1.0, "stop": 1.0},
    "preparation": {"stands": 0.0, "opposite_stands": 1.0, "initiation": 0.0, "stop": 1.0, "preparation": 1.0},
}


@modes
@pytest.mark.parametrize("case", CASES)
def test_excitations_are_those_of_the_released_model(case: str, mode: Mode) -> None:
    chance = np.random.default_rng(11)
    gate = SimpleNamespace(**({"flexion": 0.0, "hold": 0.0, "stop": 0.0, "preparation": 0.0} | CASES[case]))
    p = SimpleNamespace(**{name: float(chance.uniform(0.1, 0.9)) for name in GAINS})
    s = SimpleNamespace(**{name: float(chance.uniform(0.1, 0.9)) for name in FELT})
    s.target, s.pitch, s.pitch_rate, p.lean = 1.1, 0.05, 0.4, 0.1
    p.brake_angle, p.biceps_offset, p.biceps_vastus_offset, s.biceps_velocity = 0.05, 0.6, 0.7, 0.3
    s.rectus_velocity = -0.2 if case in ("beginning", "flexion") else 0.1
    # Fibers on either side of the lengths at which a phase ends: 0.70 (rectus) and 0.86 (hamstrings) at the target.
    s.biceps_length = 0.9
    p.clearance = 0.3 if gate.flexion else 5.0
    s.rectus_length = 0.6 if case == "preparation" else 0.9
    s.hamstrings_length = 1.1 if gate.stop or not gate.hold else 0.7
    s.hamstrings_velocity = -0.1 if gate.preparation else 0.1
    if gate.stands:
        s.hamstrings_velocity = -0.1
    assert ran(p, s, gate, mode) == pytest.approx(excitations(p, s, gate), rel=1e-12)


FRONTAL = (
    *(f"{phase}_bias_{muscle}" for phase in ("stance", "swing") for muscle in ("abductor", "adductor")),
    *("abductor_force_gain", "abductor_lean", "abductor_lean_rate", "adductor_lean", "adductor_lean_rate"),
    *("opposite_abductor_gain", "opposite_adductor_gain", "swing_abductor", "swing_adductor"),
    *("suppression", "transition"),
)
FRONTAL_FELT = (
    *("in_stance", "opposite_in_swing", "initiation", "load", "opposite_load", "opposite_abductor"),
    *("opposite_adductor", "abductor_length", "abductor_force", "adductor_length"),
)


def frontal_excitations(p: SimpleNamespace, s: SimpleNamespace) -> dict[str, float]:
    """The sums of the released model, whose target R is 90 deg less the abduction that is wanted."""
    deg = math.radians
    r, swing = math.pi / 2 - s.target, 1 - s.in_stance
    support = s.in_stance * (1 - s.initiation * p.suppression * s.opposite_load)
    swings = swing + s.initiation * p.transition * s.opposite_load
    flies = {
        "abductor": swings * p.swing_abductor * positive(s.abductor_length - (1 + 0.254 * (r - deg(69.0)))),
        "adductor": swings * p.swing_adductor * positive(s.adductor_length - (1 - 0.2039 * (r - deg(60.4)))),
    }
    flies = {name: value + swing * getattr(p, f"swing_bias_{name}") for name, value in flies.items()}
    abductor = p.abductor_lean * s.lean + p.abductor_lean_rate * s.lean_rate
    adductor = p.adductor_lean * s.lean + p.adductor_lean_rate * s.lean_rate
    total = {
        "abductor": support * p.abductor_force_gain * s.abductor_force + s.in_stance * s.load * positive(-abductor),
        "adductor": s.in_stance * s.load * positive(adductor),
    }
    for name in total:
        total[name] += s.in_stance * getattr(p, f"stance_bias_{name}") + flies[name]
        total[name] += s.opposite_in_swing * getattr(p, f"opposite_{name}_gain") * getattr(s, f"opposite_{name}")
    return {f"{name}_neurons": value for name, value in total.items()} | {
        f"{name}_swing_sum": value for name, value in flies.items()
    }


@modes
@pytest.mark.parametrize("lean", [0.1, -0.1])
@pytest.mark.parametrize("phase", [(1.0, 0.0, 0.0), (1.0, 1.0, 0.0), (1.0, 0.0, 1.0), (0.0, 0.0, 0.0)])
def test_sideways_excitations_are_those_of_the_released_model(
    phase: tuple[float, float, float], lean: float, mode: Mode
) -> None:
    chance = np.random.default_rng(13)
    p = SimpleNamespace(**{name: float(chance.uniform(0.1, 0.9)) for name in FRONTAL})
    s = SimpleNamespace(**{name: float(chance.uniform(0.6, 1.2)) for name in FRONTAL_FELT})
    s.in_stance, s.opposite_in_swing, s.initiation = phase
    s.target, s.lean, s.lean_rate = 0.08, lean, 0.02
    held = {name: ("number", "", getattr(s, name)) for name in FRONTAL_FELT}
    held |= {"target": ("angle", " rad", s.target), "lean": ("angle", " rad", s.lean)}
    held |= {"lean_rate": ("rate", " rad/s", s.lean_rate)}
    units = {"_lean": "1/rad", "_rate": "s/rad"}
    values = {name: f"{getattr(p, name)!r} {units.get(name[-5:], '')}" for name in FRONTAL}
    found = composed("controller/song2015_frontal", held, values, mode)
    wanted = frontal_excitations(p, s)
    assert {name: found[f"reflexes.{name}.excitation"] for name in wanted} == pytest.approx(wanted, rel=1e-12)
