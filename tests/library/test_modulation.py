"""Signals over time, and values over speed."""

from __future__ import annotations

import numpy as np
import pytest
from components.calls import Tables, computed, primitive

from gaitsim.simulation.run import Mode

modes = pytest.mark.parametrize("mode", ["rapid", "normal"])


def profile(times: list[float], values: list[float], at: list[float], mode: Mode) -> list[float]:
    tables, found = Tables(primitive("controller/time_profile")), []
    tables.p.times[:], tables.p.values[:] = np.nan, np.nan
    tables.p.times[: len(times)], tables.p.values[: len(values)] = times, values
    for time in at:
        tables.put({"time": time})
        assert not tables.call("output", mode)
        found.append(float(tables.y.value))
    return found


@modes
@pytest.mark.parametrize("count", [2, 5, 32])
def test_a_profile_is_linear_between_its_instants_and_constant_beyond(count: int, mode: Mode) -> None:
    random = np.random.default_rng(count)
    times, values = np.cumsum(random.uniform(0.1, 3, count)), random.normal(size=count)
    at = [0.0, *np.linspace(0, times[-1] + 1, 200), *times]
    found = profile([*times], [*values], at, mode)
    assert found == pytest.approx(np.interp(at, times, values), abs=1e-12)


@modes
def test_a_profile_runs_with_the_steps(mode: Mode) -> None:
    tables = Tables(primitive("controller/time_profile"))
    for _ in range(3):
        assert not tables.call("update", mode, 0.5)
    assert tables.x.time == 1.5


@modes
@pytest.mark.parametrize(
    ("speed", "value"), [(0.5, 1), (0.8, 1), (1.0, 1.25), (1.2, 1.5), (1.4, 1.75), (1.6, 2), (2, 2)]
)
def test_a_value_over_speed(speed: float, value: float, mode: Mode) -> None:
    given = {"slow": 0.8, "fast": 1.6, "at_slow": 1, "at_fast": 2, "speed": speed}
    assert computed("controller/speed_modulation", mode, **given).value == pytest.approx(value, rel=1e-12)
    share = min(1, max(0, (speed - 0.8) / 0.8))
    bent = computed("controller/speed_modulation", mode, bend=-0.3, **given).value
    assert bent == pytest.approx(value - 0.3 * (1 - (2 * share - 1) ** 2), rel=1e-12)
