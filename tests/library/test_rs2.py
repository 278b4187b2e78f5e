"""SCONE's controller RS2: each muscle's excitation is the sum that the published file's lines make."""

from __future__ import annotations

from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest
from components.calls import computed

from gaitsim.components.find import Library, library_folders
from gaitsim.simulation.run import Mode, Simulator
from gaitsim.spec.resolve import resolve
from gaitsim.text.document import parse

RIG = Path(__file__).parent / "rig"
ALL, STANCE, SWING = "11111", "00011", "11100"  # SCONE's names of the sets of phases
modes = pytest.mark.parametrize("mode", ["rapid", "normal"])


class Line(NamedTuple):
    """A MuscleReflex of the file: which gains it has and whether what it feels may be negative."""

    target: str
    source: str
    phases: str
    gains: str
    negative: str = "LF"


# controllers/H1922RS2v3.scone and H0918RS2v3.scone together.
LINES = (
    Line("tibialis", "tibialis", ALL, "LF"),
    Line("soleus", "soleus", ALL, "LF"),
    Line("gastrocnemius", "gastrocnemius", ALL, "LF"),
    Line("tibialis", "soleus", ALL, "LF"),
    Line("tibialis", "gastrocnemius", ALL, "LF"),
    Line("soleus", "tibialis", ALL, "F"),
    Line("gastrocnemius", "tibialis", ALL, "F"),
    Line("vasti", "vasti", STANCE, "LFV", "LFV"),
    Line("vasti", "biceps", STANCE, "LV", ""),
    Line("iliopsoas", "iliopsoas", STANCE, "L"),
    Line("rectus", "rectus", STANCE, "L"),
    Line("hamstrings", "hamstrings", STANCE, "LV", "LFV"),
    Line("hamstrings", "gastrocnemius", STANCE, "F", ""),
    Line("biceps", "biceps", STANCE, "LFV", "LFV"),
    Line("biceps", "gastrocnemius", STANCE, "F", ""),
    Line("gluteus", "gluteus", STANCE, "L"),
    Line("iliopsoas", "iliopsoas", SWING, "L"),
    Line("rectus", "rectus", SWING, "L"),
    Line("iliopsoas", "hamstrings", SWING, "L"),
    Line("hamstrings", "hamstrings", SWING, "LV", "LFV"),
    Line("biceps", "biceps", SWING, "F"),
    Line("gluteus", "gluteus", SWING, "L"),
)
TRUNK = (("hamstrings", STANCE), ("gluteus", STANCE), ("rectus", STANCE), ("iliopsoas", SWING))
SIDEWAYS = (Line("medius", "medius", STANCE, "LV", "LFV"), Line("adductor", "adductor", STANCE, "LV", "LFV"))
WORDS = {"L": "length", "F": "force", "V": "velocity"}
PHASES = {ALL: "", STANCE: "_stance", SWING: "_swing"}
# One leg stands; or it has nothing below it, behind the other and in front of it.
LOADS = {"stance": (1.0, 0.0, 0.1, -0.4), "late": (1.0, 0.0, -0.1, 0.0), "liftoff": (0.5, 0.5, -0.3, 0.3)}
LOADS |= {"swing": (0.0, 1.0, -0.1, 0.0), "landing": (0.0, 1.0, 0.2, 0.0)}


def name_of(line: Line) -> str:
    """The part of the composite that is this line."""
    source = "" if line.source == line.target else f"_{line.source}"
    return f"{line.target}{source}{PHASES[line.phases]}"


def excitations(text: str, outputs: list[str], mode: Mode) -> dict[str, float]:
    """What comes out of the reflexes at the first instant."""
    library = Library([RIG / "components", *library_folders(RIG)])
    document = parse(f"gaitsim: 1\nparts:\n{text}simulate: {{duration: 1 ms, step: 0.5 ms}}\n", "rs2.yaml")
    outcome = Simulator(resolve(document, library, "rs2"), mode).run(recorded=True)
    assert outcome.trajectory is not None, outcome.reason
    return {name: float(outcome.trajectory[f"reflexes.{name}_neurons.excitation"][0]) for name in outputs}


def drawn(lines: tuple[Line, ...], chance: np.random.Generator) -> dict[Line, dict[str, float]]:
    """Gains and offsets of each line."""
    return {
        line: {
            f"{WORDS[term]}_{what}": float(chance.uniform(*ends))
            for term in line.gains
            for what, ends in (("gain", (-2, 2)), ("offset", (0.2, 0.9) if term != "V" else (0, 0)))
        }
        for line in lines
    }


def wanted(target: str, values: dict[Line, dict[str, float]], felt: dict[str, float], phase: str) -> float:
    """U = sum of K (s - s_0), each clamped as the file says, of the lines that are active."""
    total = 0.0
    for line, numbers in values.items():
        if line.target != target or (line.phases != ALL and line.phases != phase):
            continue
        for term in line.gains:
            word = WORDS[term]
            above = felt[f"{line.source}_{word}"] - numbers[f"{word}_offset"]
            total += numbers[f"{word}_gain"] * (above if term in line.negative else max(0.0, above))
    return total


def entries(values: dict[Line, dict[str, float]]) -> str:
    return "".join(
        f"    {name_of(line)}: {{{', '.join(f'{name}: {number!r}' for name, number in numbers.items())}}}\n"
        for line, numbers in values.items()
    )


def signal(name: str, value: float, port: str, kind: str) -> tuple[str, str]:
    """A held signal, and the input that reads it."""
    unit = {"number": "", "place": " m", "angle": " rad", "rate": " rad/s"}[kind]
    return (
        f"  {name}: {{use: sensor/held, {kind}: {value!r}{unit}}}\n",
        f"    {port}: {{from: {name}.held_{kind}}}\n",
    )


@modes
@pytest.mark.parametrize("phase", LOADS)
def test_excitations_are_those_of_the_file(phase: str, mode: Mode) -> None:
    chance = np.random.default_rng(7)
    values, lean, rate = drawn(LINES, chance), 0.2, -0.3
    posture = {each: (float(chance.uniform(-2, 2)), float(chance.uniform(-1, 1))) for each in TRUNK}
    muscles = sorted({line.target for line in LINES})
    felt = {f"{muscle}_{word}": float(chance.uniform(-0.3, 1.3)) for muscle in muscles for word in WORDS.values()}
    read = {f"{line.source}_{WORDS[term]}" for line in LINES for term in line.gains}
    given = [signal(name, felt[name], name, "number") for name in sorted(read)]
    given.append(signal("knee", felt["gastrocnemius_force"], "gastrocnemius_force_at_knee", "number"))
    given += [signal("lean", lean, "pitch", "angle"), signal("rate", rate, "pitch_rate", "rate")]
    names = ("load", "opposite_load", "position", "opposite_position")
    given += [
        signal(name, value, name, "number" if "load" in name else "place")
        for name, value in zip(names, LOADS[phase], strict=True)
    ]
    text = "".join(part for part, _ in given) + "  reflexes:\n    use: controller/rs2\n"
    text += "".join(entry for _, entry in given) + entries(values)
    for (target, phases), (proportional, derivative) in posture.items():
        gains = f"proportional: {proportional!r} 1/rad, derivative: {derivative!r} s/rad"
        text += f"    {target}_trunk{PHASES[phases]}: {{{gains}}}\n"
    active = STANCE if phase in ("stance", "late") else SWING
    expected = {muscle: wanted(muscle, values, felt, active) for muscle in muscles}
    for (target, phases), (proportional, derivative) in posture.items():
        if phases == active:
            # In SCONE tilt is backwards: KP (P0 - q) - KV q' with P0 = -0.105 and q = -lean.
            expected[target] += proportional * (-0.105 + lean) + derivative * rate
    assert excitations(text, muscles, mode) == pytest.approx(expected, rel=1e-12)


@modes
@pytest.mark.parametrize("active", [STANCE, SWING])
def test_sideways_excitations_are_those_of_the_file(active: str, mode: Mode) -> None:
    chance = np.random.default_rng(9)
    values = drawn(SIDEWAYS, chance)
    felt = {
        f"{muscle}_{word}": float(chance.uniform(-0.3, 1.3))
        for muscle in ("medius", "adductor")
        for word in ("length", "velocity")
    }
    seen = {"obliquity": 0.1, "obliquity_rate": -0.4, "opposite_abduction": -0.2, "opposite_abduction_rate": 0.7}
    given = [signal(name, value, name, "number") for name, value in felt.items()]
    given += [
        signal(f"{name}_held", value, name, "rate" if "rate" in name else "angle") for name, value in seen.items()
    ]
    given += [signal("stands", float(active == STANCE), "stance", "number")]
    given += [signal("swings", float(active == SWING), "swing", "number")]
    text = "".join(part for part, _ in given) + "  reflexes:\n    use: controller/rs2_frontal\n"
    text += "".join(entry for _, entry in given) + entries(values)
    # As published for H1922: KP, KV of the pelvis; KP, KV, C0 of the other femur.
    published = {"medius": (1.20, 0.015, 0.323, 0.122, -0.037), "adductor": (-0.569, -0.026, -0.629, -0.288, -0.005)}
    expected = {}
    for muscle, (pelvis, pelvis_rate, thigh, thigh_rate, bias) in published.items():
        text += f"    {muscle}_pelvis_stance: {{proportional: {pelvis} 1/rad, derivative: {pelvis_rate} s/rad}}\n"
        text += (
            f"    {muscle}_thigh_swing: {{proportional: {thigh} 1/rad, derivative: {thigh_rate} s/rad, bias: {bias}}}\n"
        )
        expected[muscle] = wanted(muscle, values, felt, active)
        if active == STANCE:
            # On the right, the roll to the right is the obliquity turned round: KP (0 - roll) - KV roll'.
            expected[muscle] += pelvis * (0 + 0.1) + pelvis_rate * -0.4
        else:
            expected[muscle] += bias + thigh * -0.2 + thigh_rate * 0.7
    assert excitations(text, ["medius", "adductor"], mode) == pytest.approx(expected, rel=1e-12)


@modes
def test_a_muscle_reflex_alone(mode: Mode) -> None:
    values = {"length_gain": 0.65, "length_offset": 0.54, "length": 0.4, "velocity_gain": 0.3, "velocity": -0.2}
    values |= {"force_gain": -0.9, "force": 0.5, "force_offset": 0.1, "bias": 0.02}
    by_length, by_force = 0.65 * (0.4 - 0.54), -0.9 * 0.4

    def found(**more: Any) -> float:
        return float(computed("controller/muscle_reflex", mode, **values, **more).stimulation)

    assert found() == pytest.approx(0.02 + by_length + by_force)  # shortening takes nothing away
    assert found(velocity_floor=-1e6) == pytest.approx(0.02 + by_length + by_force - 0.06)
    assert found(length_floor=0.0) == pytest.approx(0.02 + by_force)
    assert found(gate=0.0) == 0
