"""The measures of walking in space on hand-made steps with known answers."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from components.calls import metrics

from gaitsim.simulation.run import Simulator

from .plane import model_of, played
from .test_measures_gait import steps, walking

DT = 0.01


@pytest.mark.parametrize("heading", [0.0, 0.5, -2.0])
def test_step_width_is_across_the_way_wherever_it_leads(heading: float) -> None:
    times = steps(10)
    left, right = walking(times, 1.0, 0.6), walking(times, 1.0, 0.6, late=0.5)
    way, across = np.array([math.cos(heading), math.sin(heading)]), np.array([-math.sin(heading), math.cos(heading)])
    prints = np.floor(times)[:, None] * 1.3 * way + 0.06 * across
    others = (np.floor(times - 0.5)[:, None] + 0.5) * 1.3 * way - 0.07 * across
    signals = {"left": left, "right": right, "left_position": prints[:, 0], "left_side_position": prints[:, 1]}
    signals |= {"right_position": others[:, 0], "right_side_position": others[:, 1]}
    found = metrics("measure/step_width", signals, DT)
    assert found == pytest.approx({"value": 0.13, "deviation": 0}, abs=1e-7)


def test_step_width_of_who_takes_no_steps_is_nothing() -> None:
    times = steps(3)
    signals = {"left": np.ones_like(times), "right": np.ones_like(times)}
    for name in ("left_position", "right_position", "left_side_position", "right_side_position"):
        signals[name] = np.zeros_like(times)
    found = metrics("measure/step_width", signals, DT)
    assert math.isnan(found["value"]) and math.isnan(found["deviation"])


@pytest.mark.parametrize("heading", [0.0, 0.5, -2.0])
def test_the_lateral_margin_is_that_of_the_extrapolated_center_of_mass(heading: float) -> None:
    """The body sways by 2 cm at 1/s between feet 6 and 7 cm beside its way; both stand alone for 0.4 s of a stride."""
    times = steps(10)
    left, right = walking(times, 1.0, 0.6), walking(times, 1.0, 0.6, late=0.5)
    way, across = np.array([math.cos(heading), math.sin(heading)]), np.array([-math.sin(heading), math.cos(heading)])
    sway, rate = 0.02 * np.sin(2 * np.pi * times), 0.04 * np.pi * np.cos(2 * np.pi * times)
    center = (1.3 * times)[:, None] * way + sway[:, None] * across
    velocity = 1.3 * way + rate[:, None] * across
    ahead = np.floor(times)[:, None] * 1.3 * way
    signals = {"left": left, "right": right, "heading": np.full_like(times, heading)}
    signals["center_height"] = np.full_like(times, 0.981)
    for name, places in (("center", center), ("left", ahead + 0.06 * across), ("right", ahead - 0.07 * across)):
        signals[f"{name}_position"], signals[f"{name}_side_position"] = places[:, 0], places[:, 1]
    signals["center_velocity"], signals["center_side_velocity"] = velocity[:, 0], velocity[:, 1]
    found = metrics("measure/lateral_margin", signals, DT, border=0.01)
    extrapolated = sway + rate * math.sqrt(0.1)
    alone = [(left > 0.5) & (right < 0.5), (right > 0.5) & (left < 0.5)]
    margins = [0.07 - np.max(extrapolated[alone[0]]), 0.08 + np.min(extrapolated[alone[1]])]
    assert found["value"] == pytest.approx(np.mean(margins), abs=1e-4)
    assert found["lowest"] == pytest.approx(min(margins), abs=1e-9)
    assert found["deviation"] == pytest.approx(abs(margins[0] - margins[1]) / 2, abs=1e-4)


def test_the_range_within_strides_leaves_out_drift_and_the_beginning() -> None:
    times = steps(12)
    signal = 0.2 * np.sin(2 * np.pi * times) + 0.1 * times  # 0.1 a stride
    found = metrics("measure/stride_range", {"signal": signal, "stance": walking(times, 1.0, 0.6)}, DT)
    inside = [signal[int(k / DT) : int((k + 1) / DT)] for k in range(2, 11)]
    assert found["high"] == pytest.approx(np.mean([part.max() for part in inside]), abs=1e-12)
    assert found["value"] == pytest.approx(np.mean([np.ptp(part) for part in inside]), abs=1e-12)


FALLS = {
    "upright": (1.0, 0.3, -0.2, 0, 0),
    "down": (0.5, 0.1, 0.1, 1, 0),
    "forwards": (0.9, 1.2, 0.1, 1, 0),
    "to the right": (0.9, 0.5, 0.8, 1, 1),
    "down to the left": (0.5, 0.2, -0.6, 1, 1),
}


@pytest.mark.parametrize("way", FALLS)
def test_a_fall_is_told_with_its_way(way: str) -> None:
    height, lean, side, fell, sideways = FALLS[way]
    times = steps(2)
    late = times >= 1
    signals = {
        "height": np.where(late, height, 1.0),
        "lean": np.where(late, lean, 0.0),
        "side_lean": np.where(late, side, 0.0),
    }
    found = metrics("measure/spatial_fall", signals, DT, below=0.7)
    assert (found["fell"], found["fell_sideways"]) == (fell, sideways)
    assert found["value"] == pytest.approx(1.0 if fell else 2.0)


def test_a_block_that_stands_on_its_edge_falls_to_the_side_at_once(tmp_path: Path) -> None:
    text = """
gaitsim: 1
parts:
  block: {use: segment/spatial, mass: 60 kg, inertia_forward: 3 kg m^2, inertia_left: 3 kg m^2, inertia_up: 1 kg m^2}
  root: {use: joint/spatial, parent: world, child: block.center}
  heel: {use: contact/spatial_hunt_crossley, frame: {on: block.center, at: [-10 cm, 0 cm, -1 m]}}
  toe: {use: contact/spatial_hunt_crossley, frame: {on: block.center, at: [10 cm, 0 cm, -1 m]}}
initial: {root.roll: 10 deg}
measures:
  fall:
    use: measure/spatial_fall
    below: 0.5 m
    height: {from: root.z}
    lean: {from: root.pitch}
    side_lean: {from: root.roll}
simulate: {duration: 5 s, step: 1 ms}
"""
    outcome = Simulator(model_of(text, tmp_path)).run()
    assert outcome.metrics["fall.fell_sideways"] == 1
    assert 0.1 < outcome.metrics["fall"] < 1.5
    assert outcome.ending == "fall, fell to the right"


FEET = """
gaitsim: 1
parts:
  block: {use: segment/spatial, mass: 60 kg, inertia_forward: 1 kg m^2, inertia_left: 1 kg m^2, inertia_up: 1 kg m^2}
  root: {use: joint/spatial, parent: world, child: block.center}
  heel:
    use: contact/spatial_hunt_crossley
    sides: [l, r]
    frame: {on: block.center, at: [-10 cm, -20 cm, -3 cm]}
    to: {force: "foot_{side}.normal", friction_force: "foot_{side}.forward", side_force: "foot_{side}.left"}
  toe:
    use: contact/spatial_hunt_crossley
    sides: [l, r]
    frame: {on: block.center, at: [10 cm, -20 cm, -3 cm]}
    to: {force: "foot_{side}.normal", friction_force: "foot_{side}.forward", side_force: "foot_{side}.left"}
  foot: {use: sensor/ground_force, sides: [l, r]}
  push: {use: perturbation/push, frame: block.center, direction: left, strength: 100 N, duration: 2 s, onset: 0 s}
simulate: {duration: 1.5 s, step: 0.5 ms}
"""


def test_the_force_on_a_foot_is_medial_towards_the_other_foot(tmp_path: Path) -> None:
    found = played(FEET, tmp_path)
    last = {name: found[name][-1] for name in found.signals}
    # The ground holds against the push: to the right, which is medial for the left foot only.
    assert last["foot_l.total_medial"] - last["foot_r.total_medial"] == pytest.approx(100, rel=0.02)
    assert last["foot_l.total_medial"] > 0 > last["foot_r.total_medial"]
    assert last["foot_l.load"] + last["foot_r.load"] == pytest.approx(1, rel=1e-2)
    assert last["foot_l.medial_load"] * 60 * 9.81 == pytest.approx(last["foot_l.total_medial"])
