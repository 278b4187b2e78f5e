"""Clocks and stimulation without feedback."""

from __future__ import annotations

import math

import numpy as np
import pytest
from components.calls import computed

from gaitsim.simulation.run import Mode

from .play import played

modes = pytest.mark.parametrize("mode", ["rapid", "normal"])


@modes
def test_a_clock_runs_round(mode: Mode) -> None:
    found = played("controller/clock", {"event": [0.0] * 2500}, mode, period=0.8, first_phase=0.25)
    time = np.arange(2500) * 1e-3
    exact = (0.25 + time / 0.8) % 1
    # At a whole number of periods rounding decides between 0 and nearly 1.
    distance = np.abs((np.array(found["phase"]) - exact + 0.5) % 1 - 0.5)
    assert distance.max() < 1e-12
    assert min(found["phase"]) >= 0 and max(found["phase"]) < 1


@modes
def test_an_event_begins_the_cycle_anew(mode: Mode) -> None:
    events = [0, 0, 0, 1, 0, 0]
    found = played("controller/clock", {"event": events}, mode, dt=0.1, period=1.0, first_phase=0.5)
    assert found["phase"] == pytest.approx([0.5, 0.6, 0.7, 0.5, 0.6, 0.7])


@modes
@pytest.mark.parametrize(
    ("phase", "distance"), [(0.9, 0.0), (0.95, 0.05), (0.05, 0.15), (0.85, -0.05), (0.4, 0.5), (1.9, 0.0)]
)
def test_a_bell_reaches_round_the_cycle(phase: float, distance: float, mode: Mode) -> None:
    values = {"height": 0.4, "center": 0.9, "width": 0.1, "phase": phase}
    found = computed("controller/gaussian_profile", mode, **values).stimulation
    assert found == pytest.approx(0.4 * math.exp(-0.5 * (distance / 0.1) ** 2), rel=1e-9)
    assert computed("controller/gaussian_profile", mode, gate=0.0, **values).stimulation == 0


@modes
def test_lines_between_eight_values(mode: Mode) -> None:
    corners = [0.1, 0.5, -0.2, 0.0, 0.9, 0.3, 0.3, 0.7]
    values = {f"value_{i}": value for i, value in enumerate(corners)}
    for phase in np.linspace(0, 1, 81):
        found = computed("controller/linear_profile", mode, phase=phase, **values).stimulation
        exact = np.interp(phase, np.arange(9) / 8, [*corners, corners[0]])
        assert found == pytest.approx(exact, abs=1e-12)
    assert computed("controller/linear_profile", mode, phase=0.3, gate=0.0, **values).stimulation == 0
