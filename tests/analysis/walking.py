"""A walk made by hand: the walker's model, with signals that nobody simulated and whose gait is known."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from gaitsim.analysis.replays.replay import Replay
from gaitsim.model import Model, recorded_signals
from gaitsim.simulation.outcome import Outcome, Trajectory
from tests.simulation.models import ROOT
from tests.simulation.models import model as model_of

Floats = NDArray[np.float64]

SPEC = ROOT / "specs" / "walking_geyer2010.yaml"
STEP, STRIDE, STANCE = 0.005, 1.2, 0.6  # s, s, share of the stride
WEIGHT = 80 * 9.81  # N
FOOT = 0.2  # m: from heel to ball
LATE = {"r": 0.0, "l": 0.5}  # touchdowns of a side, in strides
PRINT = {"r": 0.0, "l": 0.65}  # m: of the first footprint; the right foot steps 0.75 m, the left 0.65 m
TIMES = STEP * np.arange(2401)


@cache
def model() -> Model:
    """The archive's walker."""
    return model_of(SPEC)


def phase(side: str) -> Floats:
    """Place in the stride of a leg, from 0 to 1."""
    return np.mod(TIMES / STRIDE - LATE[side] + 1e-9, 1.0)


def on_ground(side: str) -> Floats:
    """1 while a leg stands."""
    return (phase(side) < STANCE).astype(float)


def position(side: str) -> Floats:
    """Of a heel, in m: it stays where it landed, rises and slides by 5 cm, and goes to its next print."""
    number = np.floor(TIMES / STRIDE - LATE[side] + 1e-9)
    ahead = np.interp(phase(side), [0, 0.3, STANCE, 1], [0, 0, 0.05, 1.4])
    return PRINT[side] + 1.4 * number + ahead


def walk(signals: Mapping[str, Floats | float], used: Model | None = None) -> Replay:
    """A run with these signals; the heels' loads and the places of heels and balls are the gait's own, all others 0."""
    chosen = used or model()
    recorded = recorded_signals(chosen)
    columns = {signal.address: i for i, signal in enumerate(recorded)}
    values = np.zeros((len(TIMES), len(recorded)))
    for side in ("l", "r"):
        heel = f"leg_{side}.heel"
        values[:, columns[f"{heel}.load"]] = on_ground(side)
        values[:, columns[f"{heel}.force"]] = WEIGHT * on_ground(side)
        values[:, columns[f"{heel}.position"]] = position(side)
        front = next(n for n in ("ball", "medial_ball", "medial_toe") if f"leg_{side}.{n}.position" in columns)
        values[:, columns[f"leg_{side}.{front}.position"]] = position(side) + FOOT
    if "center.height" in columns:
        values[:, columns["center.height"]] = 1
    for address, signal in signals.items():
        values[:, columns[address]] = signal
    trajectory = Trajectory(TIMES, tuple(columns), tuple(s.unit for s in recorded), values)
    outcome = Outcome("completed", "", len(TIMES), STEP, {}, None, 0.0, trajectory)
    return Replay("walk", SPEC, chosen, outcome)


def bent(label: str, degrees: float) -> Replay:
    """A walk whose knees bend as far, once in each stride."""
    bend = {s: np.pi - np.radians(degrees) * np.sin(np.pi * phase(s)) for s in ("l", "r")}
    return replace(walk({f"leg_{s}.knee.angle": angle for s, angle in bend.items()}), label=label)


def extended(folder: Path, more: str) -> Model:
    """The walker with more lines in its spec."""
    path = folder / "walk.yaml"
    path.write_text(f"gaitsim: 1\nextends: {SPEC}\n{more}", encoding="utf-8")
    return model_of(path)
