"""Tools in bench/ whose numbers stand in the documentation."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from gaitsim.simulation.outcome import Trajectory

ROOT = Path(__file__).resolve().parents[1]


@pytest.fixture(autouse=True)
def bench(monkeypatch: pytest.MonkeyPatch) -> None:
    """Imports from the folder, as when one of its files runs."""
    monkeypatch.syspath_prepend(str(ROOT / "bench"))
    for path in (ROOT / "bench").glob("*.py"):
        monkeypatch.delitem(sys.modules, path.stem, raising=False)


@pytest.mark.parametrize("heading", [0.0, 0.7])
def test_touchdowns_of_a_walk_that_is_known(heading: float) -> None:
    """It steps every 0.5 s, left first, at 1.2 m/s. It sways to the standing foot, which is 8 cm aside."""
    from touchdowns import touchdowns

    times = np.arange(0, 4, 0.01)
    side = np.where(np.floor(times / 0.5 + 1e-9) % 2 == 0, 1.0, -1.0)  # 1 while the left foot stands
    cosine, sine = np.cos(heading), np.sin(heading)

    def ahead(forward: Any, left: Any) -> Any:
        return cosine * forward - sine * left

    def aside(forward: Any, left: Any) -> Any:
        return sine * forward + cosine * left

    signals = {
        "leg_l.ground.load": side > 0,
        "leg_r.ground.load": side < 0,
        "leg_l.heel.position": ahead(1.2 * times + 0.3, 0.08),
        "leg_r.heel.position": ahead(1.2 * times + 0.3, -0.08),
        "leg_l.heel.side_position": aside(1.2 * times + 0.3, 0.08),
        "leg_r.heel.side_position": aside(1.2 * times + 0.3, -0.08),
        "center.forward": ahead(1.2 * times, 0.02 * side),
        "center.left": aside(1.2 * times, 0.02 * side),
        "center.forward_velocity": ahead(1.2, 0.3 * side),
        "center.left_velocity": aside(1.2, 0.3 * side),
        "root.yaw": heading + 0 * times,
        "root.roll": 0.05 * side,
        "root.pitch": 0.1 + 0 * times,
    }
    table = np.stack(list(signals.values()), axis=1).astype(float)
    rows = touchdowns(Trajectory(times, tuple(signals), ("1",) * len(signals), table))
    assert len(rows) == 7  # the foot that stands at the start did not land
    assert rows[1:] == pytest.approx(np.tile([-0.05, 0.1, -0.3, 0.06, 0.5, 1.2], (6, 1)))


def test_the_growth_of_a_deviation_is_that_of_the_map() -> None:
    """A deviation that is turned and multiplied by 1.5 in each step."""
    from orbit import factor, sizes
    from touchdowns import SCALES

    walk = np.arange(48.0).reshape(8, 6)
    turns = np.array([[np.cos(0.7 * k), np.sin(0.7 * k), 0, 0, 0, 0] for k in range(8)]) * SCALES
    others = [walk + first * 1.5 ** np.arange(8)[:, None] * turns for first in (-0.01, 0.04)]
    found = sizes(walk, [*others, others[0][:6]])
    assert found[0] == pytest.approx((0.01 * 0.04 * 0.01) ** (1 / 3))
    assert len(found) == 6
    assert factor(found) == pytest.approx(1.5)


def test_a_changed_gain_keeps_the_mean_stimulation() -> None:
    """Of G (l - l_0), at the mean length while the reflex acts, here 1.1 in stance and anything in swing."""
    from regular import Changes

    from gaitsim.study.opening import Opening

    model = Opening(ROOT / "specs" / "walking_scone_h1922.yaml", ()).open().model()
    times, start = np.arange(0, 6, 0.01), np.array(model.start)
    stance = times % 1.0 < 0.6
    length = np.where(stance, 1.1 + 0.1 * np.sin(2 * np.pi * times / 0.1), 0.7)
    readers = [address for address in (f"{part.address}.length" for part in model.parts) if "reflexes." in address]
    senders = {connection.sender for connection in model.connections if connection.target in readers}
    signals = {
        **dict.fromkeys(senders, length),
        **{reader.replace(".length", ".stimulation"): 0.2 * stance for reader in readers},
    }
    table = np.stack(list(signals.values()), axis=1)
    changes = Changes(model, start, Trajectory(times, tuple(signals), ("1",) * len(signals), table))
    assert changes.values(np.zeros(start.size)) == pytest.approx(start)
    gain, offset = (changes.names.index(f"leg.reflexes.iliopsoas_stance.length_{kind}") for kind in ("gain", "offset"))
    wanted = np.zeros(start.size)
    wanted[gain] = np.log(2)
    found = changes.values(wanted)
    assert found[gain] == pytest.approx(2 * start[gain])
    assert found[gain] * (1.1 - found[offset]) == pytest.approx(start[gain] * (1.1 - start[offset]), rel=1e-3)
    others = np.delete(np.arange(start.size), [gain, offset])
    assert found[others] == pytest.approx(start[others])


@pytest.mark.parametrize(
    ("signal", "factor", "more"), [("root.yaw", 3.0, 20 * (0.6 - 0.235)), ("left", 1.2, 5 * (1.32 - 1.24) + 15 * 0.24)]
)
def test_what_is_beyond_peoples_range_costs_more(signal: str, factor: float, more: float) -> None:
    """A walk within it costs its mean squared activation only. Blows on one leg differ from the other's as well."""
    from regular import unlike_people

    times = np.arange(0, 12, 0.01)
    wave = np.sin(2 * np.pi * times / 1.1)
    signals = {
        "root.yaw": 0.1 * wave,
        "root.roll": 0.08 * wave,
        "leg_l.ground.load": 1.2 * np.abs(wave),
        "leg_r.ground.load": 1.2 * np.abs(wave),
        "leg_l.knee.angle": -1 + 0 * times,
        "leg_r.knee.angle": -1 + 0 * times,
        "leg_l.soleus.activation": 0.1 + 0 * times,
    }

    def cost() -> float:
        table = np.stack(list(signals.values()), axis=1)
        return unlike_people(Trajectory(times, tuple(signals), ("1",) * len(signals), table))

    assert cost() == pytest.approx(10 * 0.1**2)
    changed = signal if "." in signal else f"leg_{signal[0]}.ground.load"
    signals[changed] = factor * signals[changed]
    assert cost() == pytest.approx(0.1 + more, rel=0.02)
