"""Phases of gait, events and what is held at them, from hand-made loads."""

from __future__ import annotations

import numpy as np
import pytest

from gaitsim.simulation.run import Mode

from .play import played

modes = pytest.mark.parametrize("mode", ["rapid", "normal"])


@modes
def test_a_stride_of_two_legs(mode: Mode) -> None:
    """Own load and the other's over a stride; a phase is known one step after its loads."""
    own = [0.0, 0.0, 0.5, 0.9, 1.0, 1.0, 0.6, 0.2, 0.0, 0.0]
    other = [1.0, 1.0, 0.5, 0.1, 0.0, 0.0, 0.4, 0.8, 1.0, 1.0]
    found = played("controller/gait_phase", {"load": own, "opposite_load": other}, mode)
    assert found["in_stance"] == [0, 0, 0, 1, 1, 1, 1, 1, 1, 0]
    assert found["in_swing"] == [1, 1, 1, 0, 0, 0, 0, 0, 0, 1]
    # At its own landing the other is behind; only from the other's landing on is it behind itself.
    assert found["in_double_support"] == [0, 0, 0, 0, 0, 0, 0, 1, 1, 0]
    assert found["touchdown"] == [0, 0, 0, 1, 0, 0, 0, 0, 0, 0]
    assert found["takeoff"] == [0, 0, 0, 0, 0, 0, 0, 0, 0, 1]
    mirrored = played("controller/gait_phase", {"load": other, "opposite_load": own}, mode)
    assert mirrored["in_double_support"] == [0, 0, 0, 1, 0, 0, 0, 0, 0, 0]


@modes
def test_the_two_legs_never_both_trail(mode: Mode) -> None:
    chance = np.random.default_rng(7)
    loads = chance.uniform(0, 0.3, (2, 400))
    left, right = (
        played("controller/gait_phase", {"load": a, "opposite_load": b}, mode) for a, b in (loads, loads[::-1])
    )
    behind = [left["in_double_support"], right["in_double_support"]]
    assert np.max(np.sum(behind, axis=0)) == 1 and np.min(np.max(behind, axis=1)) == 1
    for leg in (left, right):
        assert np.all(np.array(leg["in_double_support"]) <= np.array(leg["in_stance"]))
        steps = np.diff(leg["in_stance"])
        assert np.array_equal(steps > 0, np.array(leg["touchdown"])[1:] > 0)
        assert np.array_equal(steps < 0, np.array(leg["takeoff"])[1:] > 0)


@modes
def test_a_leg_alone_swings_and_stands(mode: Mode) -> None:
    """Without another leg the threshold alone decides; it is tunable and not reached by equality."""
    found = played("controller/gait_phase", {"load": [0.3, 0.2, 0.21, 0.2]}, mode, threshold=0.2)
    assert found["in_stance"] == [1, 1, 0, 1]
    assert not any(found["in_double_support"])
    assert found["touchdown"] == [0, 0, 0, 1] and found["takeoff"] == [0, 0, 1, 0]


@modes
def test_a_leg_said_to_stand_stands_until_it_was_loaded_and_unloaded(mode: Mode) -> None:
    found = played("controller/gait_phase", {"load": [0.0, 0.0, 0.5, 0.5, 0.0, 0.0]}, mode, initial={"phase": 1})
    assert found["in_stance"] == [1, 1, 1, 1, 1, 0]
    assert not any(found["touchdown"]) and found["takeoff"] == [0, 0, 0, 0, 0, 1]


@modes
def test_landing_together_leaves_no_leg_behind(mode: Mode) -> None:
    both = [0.0, 0.5, 0.5, 0.5]
    found = played("controller/gait_phase", {"load": both, "opposite_load": both}, mode)
    assert found["in_stance"] == [0, 0, 1, 1] and not any(found["in_double_support"])


@modes
def test_a_foot_that_bounces_ends_double_support_for_a_while(mode: Mode) -> None:
    other = [0.0, 0.5, 0.0, 0.5, 0.5]
    found = played("controller/gait_phase", {"load": [1.0] * 5, "opposite_load": other}, mode)
    assert found["in_double_support"] == [0, 0, 1, 0, 1]


@modes
def test_sample_and_hold(mode: Mode) -> None:
    found = played("controller/sample_hold", {"signal": [3, 4, 5, 6, 7, 8], "event": [0, 0, 1, 0, 0, 1]}, mode)
    assert found["held"] == [3, 3, 5, 5, 5, 8]


def scone(mode: Mode, **signals: list[float]) -> list[str]:
    """The phase at each instant, by name."""
    found = played("controller/scone_phases", signals, mode)
    names = ("early_stance", "late_stance", "liftoff", "swing", "landing")
    assert all(sum(found[name][i] for name in names) == 1 for i in range(len(found["swing"])))
    for i in range(len(found["swing"])):
        assert found["in_stance"][i] == found["stance_before_liftoff"][i] + found["liftoff"][i]
        assert found["in_swing"][i] == 1 - found["in_stance"][i]
    return [next(name for name in names if found[name][i]) for i in range(len(found["swing"]))]


@modes
def test_the_five_phases_of_a_stride(mode: Mode) -> None:
    """Each phase follows one step after its condition; thresholds are 0.1 body weights and 0 m."""
    phases = scone(
        mode,
        load=[0.8, 1.0, 1.0, 0.5, 0.1, 0.0, 0.0, 0.4, 0.9],
        opposite_load=[0.0, 0.0, 0.0, 0.5, 0.9, 1.0, 1.0, 0.6, 0.1],
        position=[0.2, 0.1, -0.1, -0.3, -0.4, -0.2, 0.1, 0.3, 0.2],
        opposite_position=[-0.4, -0.1, 0.1, 0.3, 0.2, 0.1, 0.0, -0.3, -0.4],
    )
    assert phases[:5] == ["early_stance", "early_stance", "early_stance", "late_stance", "liftoff"]
    assert phases[5:] == ["swing", "swing", "landing", "early_stance"]


@modes
@pytest.mark.parametrize(
    ("load", "other", "position", "other_position", "phase"),
    [
        (1.0, 0.0, 0.1, 0.0, "early_stance"),
        (1.0, 0.0, -0.1, 0.0, "late_stance"),
        (0.5, 0.5, -0.3, 0.3, "liftoff"),
        (0.5, 0.5, 0.3, -0.3, "early_stance"),
        (0.1, 1.0, -0.1, 0.0, "swing"),
        (0.0, 1.0, 0.1, 0.0, "landing"),
    ],
)
def test_the_phase_at_the_start(
    load: float, other: float, position: float, other_position: float, phase: str, mode: Mode
) -> None:
    signals = {"load": load, "opposite_load": other, "position": position, "opposite_position": other_position}
    assert scone(mode, **{name: [value] for name, value in signals.items()}) == [phase]


@modes
def test_a_scuffing_foot_stays_in_swing(mode: Mode) -> None:
    signals = {"opposite_load": [1.0] * 4, "position": [-0.3] * 4, "opposite_position": [0.1] * 4}
    assert scone(mode, load=[0.0, 0.3, 0.3, 0.0], **signals) == ["swing"] * 4


@modes
def test_a_foot_far_behind_is_lifted(mode: Mode) -> None:
    signals = {"load": [1.0] * 3, "opposite_load": [0.0] * 3, "opposite_position": [0.0] * 3}
    found = played("controller/scone_phases", {**signals, "position": [-0.1, -0.4, -0.4]}, mode, liftoff_position=-0.3)
    assert found["late_stance"] == [1, 1, 0] and found["liftoff"] == [0, 0, 1]


@modes
def test_events_of_the_five_phases(mode: Mode) -> None:
    signals = {"opposite_load": [1.0] * 5, "position": [-0.3, -0.3, 0.2, 0.2, 0.2], "opposite_position": [0.1] * 5}
    found = played("controller/scone_phases", {"load": [0.5, 0.0, 0.0, 0.5, 0.5], **signals}, mode)
    assert found["takeoff"] == [0, 0, 1, 0, 0]
    assert found["touchdown"] == [0, 0, 0, 0, 1]
