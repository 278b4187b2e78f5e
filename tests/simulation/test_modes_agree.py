"""Rapid and normal mode give the same run; a candidate's numbers depend on nothing but itself."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest

from gaitsim.model import Model
from gaitsim.simulation.outcome import Outcome
from gaitsim.simulation.run import Simulator

from .models import HOPPER, OWN, ROOT, SPECS, Settings, model, simulator

FALL = f"{-math.sqrt(2 * 9.81 * 0.163)!r} m/s"
LANDING = [("initial.guide.position", "0.99 m"), ("initial.guide.velocity", FALL)]
# The fast set; other specs differ from these in components, whose kernels tests/components compares.
FAST: dict[str, Settings] = {
    "pendulum_pid": [("simulate.duration", "1 s")],
    "hopping_geyer2003": [*LANDING, ("simulate.duration", "0.4 s")],
    "hopping_leg_mass": [("simulate.duration", "0.3 s")],
    "walking_geyer2010": [("simulate.duration", "0.3 s")],
    "walking_geyer2010_mujoco_contact": [("simulate.duration", "0.1 s")],
    "walking_scone_h1922": [("simulate.duration", "0.06 s")],
}
RUNS: list[tuple[Path, Settings]] = [
    *[(path, ()) for path in SPECS],
    # The first second of the hopper is a fall and one stance; from touchdown it also takes off.
    (HOPPER, LANDING),
    # Two short hops: the feedback, the hold and the take-off twice.
    (
        HOPPER,
        [
            ("initial.guide.position", "1 m"),
            ("feedback.gain", "15"),
            ("simulate.step", "0.1 ms"),
        ],
    ),
]
NAMES = [f"{path.stem}{'-' + '-'.join(a for a, _ in s) if s else ''}" for path, s in RUNS]

# length, mass, radius of gyration, stiffness
CANDIDATES = [
    [0.5, 2.0, 0.3, 20.0],
    [0.9, 1.0, 0.25, 5.0],
    [0.5, 2.0, 0.3, 1e9],  # diverges on the way
    [0.25, 4.5, 0.4, 60.0],
    [0.3, 2.0, 0.001, 20.0],  # an inertia that no body has
]
REASONS = ["", "", "the mechanics diverged", "", "a moment of inertia is at most"]


def facts(outcome: Outcome) -> tuple[object, ...]:
    """All of an outcome but the time it took; floats by their bits."""
    record = outcome.trajectory.values.tobytes() if outcome.trajectory is not None else b""
    metrics = {name: value.hex() for name, value in outcome.metrics.items()}
    score = None if outcome.score is None else outcome.score.hex()
    return (outcome.status, outcome.reason, outcome.steps, metrics, score, record)


def length_of(path: Path) -> str:
    """How long a spec runs: a second, but less for one that only varies another."""
    if path.stem == "walking_simplest":
        return "5 s"  # of its dimensionless time, in steps of 20 ms: beyond its first heel strike
    return "0.3 s" if "\nextends:" in path.read_text() else "1 s"


@pytest.mark.parametrize(("name", "settings"), FAST.items(), ids=FAST)
def test_every_signal_agrees_at_the_beginning(name: str, settings: Settings) -> None:
    agree(model(ROOT / "specs" / f"{name}.yaml", settings))


@pytest.mark.parametrize("path", sorted(OWN.glob("*.yaml")), ids=lambda path: path.stem)
def test_every_signal_of_our_own_specs_agrees(path: Path) -> None:
    agree(model(path))


@pytest.mark.slow
@pytest.mark.parametrize(("path", "settings"), RUNS, ids=NAMES)
def test_every_signal_agrees_over_the_first_second(path: Path, settings: Settings) -> None:
    agree(model(path, [*settings, ("simulate.duration", length_of(path))]))


def agree(made: Model) -> None:
    """Assert that both modes give the same run."""
    rapid = Simulator(made, "rapid").run(recorded=True)
    normal = Simulator(made, "normal").run(recorded=True)
    assert rapid.trajectory is not None and normal.trajectory is not None
    assert (rapid.status, rapid.reason, rapid.steps) == (normal.status, normal.reason, normal.steps)
    assert rapid.status != "failed", rapid.reason
    assert len(rapid.trajectory.times) == rapid.steps + (rapid.status == "stopped") > 100
    assert rapid.trajectory.signals == normal.trajectory.signals
    for signal in rapid.trajectory.signals:
        mine, theirs = rapid.trajectory[signal], normal.trajectory[signal]
        size = max(1e-6, float(np.abs(theirs).max()))
        np.testing.assert_allclose(mine, theirs, rtol=1e-9, atol=1e-9 * size, err_msg=signal)
    assert rapid.metrics.keys() == normal.metrics.keys()
    for name, value in rapid.metrics.items():
        assert value == pytest.approx(normal.metrics[name], rel=1e-9, abs=1e-12, nan_ok=True), name
    assert (rapid.score is None) == (normal.score is None)
    if rapid.score is not None:
        assert rapid.score == pytest.approx(normal.score, rel=1e-9)


@pytest.mark.parametrize("mode", ["rapid", "normal"])
def test_candidates_in_any_order_give_the_same_bits(mode: str) -> None:
    made = model(OWN / "tuned_rod.yaml", [("simulate.duration", "0.5 s")])
    assert [free.address for free in made.free] == [
        "rod.mass",
        "rod.length",
        "rod.radius_of_gyration",
        "spring.stiffness",
    ]
    candidates = [[mass, length, *rest] for length, mass, *rest in CANDIDATES]
    alone = [facts(Simulator(made, mode).run(each, recorded=True)) for each in candidates]
    for (status, reason, *_), expected in zip(alone, REASONS, strict=True):
        assert status == ("failed" if expected else "completed")
        assert expected in str(reason)
    assert len(set(map(str, alone))) == len(candidates)
    together = Simulator(made, mode)
    orders: list[Sequence[int]] = [(0, 1, 2, 3, 4), (4, 3, 2, 1, 0), (2, 0, 4, 1, 3), (3, 3, 4, 0, 2)]
    for order in orders:
        for i in order:
            assert facts(together.run(candidates[i], recorded=True)) == alone[i], (order, i)
    # Recording is only looking.
    for candidate, (*told, _) in zip(candidates, alone, strict=True):
        assert list(facts(together.run(candidate)))[:-1] == told


def test_a_failed_candidate_says_the_same_in_both_modes() -> None:
    made = model(OWN / "tuned_rod.yaml")
    diverging = [2.0, 0.5, 0.3, 2.5e6]
    rapid = Simulator(made, "rapid").run(diverging, recorded=True)
    normal = Simulator(made, "normal").run(diverging, recorded=True)
    assert rapid.reason == normal.reason
    assert rapid.reason.startswith("the mechanics diverged: pivot moves at 1")
    assert rapid.steps == normal.steps
    assert rapid.trajectory is not None and normal.trajectory is not None
    np.testing.assert_allclose(rapid.trajectory.values, normal.trajectory.values, rtol=1e-9)


def test_a_component_out_of_its_domain_is_named_in_both_modes() -> None:
    short = [("leg.segment_length", "45 cm"), ("simulate.duration", "1 s")]
    reasons = {simulator(HOPPER, short, mode).run().reason for mode in ("rapid", "normal")}
    assert reasons == {
        "leg (leg/virtual_two_segment) gives no finite number in output at 0 s: "
        "knee_angle = nan, knee_velocity = nan, knee_offset = nan, force = nan"
    }


def test_a_joint_that_jumps_in_mid_run_ends_both_modes_alike() -> None:
    # All numbers stay finite, and 6 s later the knee is slow again: only within the run can this be seen.
    jumping = [("ground.damping", "100 kN s/m")]
    rapid, normal = (
        simulator(ROOT / "specs" / "hopping_leg_mass.yaml", jumping, mode).run() for mode in ("rapid", "normal")
    )
    assert (rapid.status, rapid.metrics) == ("failed", {})
    assert rapid.reason.startswith("the mechanics diverged: knee moves at ")
    assert rapid.steps > 500
    assert facts(rapid) == facts(normal)
