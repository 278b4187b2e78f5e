"""The hopper whose leg has mass: closed loops, energy, recurring hops, what is stored at the start."""

from __future__ import annotations

import time
from collections.abc import Sequence
from pathlib import Path

import mujoco
import numpy as np
import pytest

from gaitsim.errors import SimulationFailed
from gaitsim.simulation.outcome import Outcome, Trajectory
from gaitsim.simulation.run import Simulator

from .models import ROOT, model, simulator

LEG = ROOT / "specs" / "hopping_leg_mass.yaml"
FREE = ROOT / "specs" / "hopping_leg_mass_free.yaml"
PRELOAD = ROOT / "specs" / "hopping_leg_mass_preload.yaml"


def recorded(path: Path, *settings: tuple[str, str]) -> Trajectory:
    outcome = simulator(path, settings).run(recorded=True)
    assert outcome.status == "completed", outcome.reason
    assert outcome.trajectory is not None
    return outcome.trajectory


@pytest.mark.parametrize("knee", ["32 deg", "40 deg", "90 deg", "130 deg"])
def test_the_initial_pose_closes_the_loop(knee: str) -> None:
    made = recorded(LEG, ("parameters.knee_angle.default", knee), ("simulate.duration", "1 ms"))
    angle = float(knee.split()[0])
    assert np.degrees(made["knee.angle"][0]) == pytest.approx(angle, abs=1e-12)
    assert made["ground.height"][0] == pytest.approx(0.1, abs=1e-12)  # the drop, as the spec computes it
    assert made["restrictor.deviation"][0] == pytest.approx(0, abs=1e-12)
    assert made["restrictor.energy"][0] == pytest.approx(0, abs=1e-12)
    # The thigh goes forwards by about half the bend.
    assert np.degrees(made["hip.angle"][0]) == pytest.approx(-angle / 2, abs=0.3)


def test_what_initial_sets_stays_and_velocities_follow() -> None:
    with_speed = [("initial.knee.velocity", "3 rad/s"), ("initial.guide.velocity", "-1 m/s")]
    made = recorded(LEG, *with_speed, ("simulate.duration", "1 ms"))
    assert made["knee.velocity"][0] == pytest.approx(3, abs=1e-12)
    assert made["guide.velocity"][0] == pytest.approx(-1, abs=1e-12)
    assert made["hip.velocity"][0] == pytest.approx(-1.5, abs=0.01)
    assert made["restrictor.deviation"][1] == pytest.approx(0, abs=1e-6)


def test_a_pose_that_closes_no_loop_is_a_failed_run() -> None:
    said = "no initial pose closes restrictor: a gap of .* remains; change what initial: sets"
    with pytest.raises(SimulationFailed, match=said):
        simulator(LEG, [("initial.hip.angle", "20 deg")])


def test_a_candidate_that_closes_no_loop_fails_and_the_next_one_runs(tmp_path: Path) -> None:
    spec = tmp_path / "hip.yaml"
    # Thigh and shank lie on one vertical at hip -20 deg only near 40 deg of the knee.
    spec.write_text(
        f"""
gaitsim: 1
extends: {LEG}
parameters: {{lean: {{unit: rad, default: {{value: -19.95 deg, tune: [-60 deg, 60 deg]}}}}}}
initial: {{hip.angle: =lean, knee.angle: null}}
simulate: {{duration: 10 ms}}
""",
        encoding="utf-8",
    )
    runner = simulator(spec)
    start = runner.model.start
    where = [free.address for free in runner.model.free].index("lean")
    before = runner.run(start)
    for lean in (0.3, -0.3):
        there = runner.run([*start[:where], lean, *start[where + 1 :]])
        assert there.status == "completed", there.reason  # the knee follows
    assert facts(runner.run(start)) == facts(before)


def facts(outcome: Outcome) -> tuple[object, ...]:
    metrics = {name: value.hex() for name, value in outcome.metrics.items()}
    return (outcome.status, outcome.reason, outcome.steps, outcome.score, metrics)


def test_closing_is_quick_and_always_the_same() -> None:
    body = simulator(LEG)._loop.physics
    values = body.program.model.values()
    body.pose(values)
    first = body.data.qpos.copy()
    began = time.perf_counter()
    for _ in range(50):
        body.pose(values)
        assert np.array_equal(body.data.qpos, first)
    assert (time.perf_counter() - began) / 50 < 2e-3


def test_a_model_without_loops_is_left_as_it_is() -> None:
    body = simulator(ROOT / "specs" / "pendulum_pid.yaml")._loop.physics
    body.pose(body.program.model.values())
    assert body.data.qpos == pytest.approx([np.radians(170)], abs=0)


def test_the_mechanics_load_in_stock_mujoco() -> None:
    made = simulator(LEG)
    loaded = mujoco.MjModel.from_xml_string(made.xml)
    assert loaded.neq == 1 and loaded.nv == 3
    assert loaded.body_subtreemass[0] == pytest.approx(80 * (0.678 + 0.1 + 0.0465))


def work(made: Trajectory, force: str, velocity: str) -> float:
    power = made[force] * made[velocity]
    return float(np.trapezoid(power, made.times))


def test_energy_is_what_the_muscle_gives_less_what_stops_and_ground_take() -> None:
    errors = []
    for step in ("0.1 ms", "0.05 ms"):
        made = recorded(LEG, ("simulate.step", step), ("simulate.duration", "3 s"))
        muscle = -work(made, "extensor.force", "extensor.path.velocity")
        ground = work(made, "ground.force", "ground.velocity")
        stop = work(made, "knee.stop", "knee.velocity")
        change = made["energy.total"][-1] - made["energy.total"][0]
        errors.append(abs(change - muscle - ground - stop))
        assert ground < 0 and stop < 0 < muscle
        assert errors[-1] < 0.008 * (muscle - ground - stop)
        # Between path and fiber there is only the tendon.
        stored = made["extensor.tendon_energy"]
        fiber = -work(made, "extensor.force", "extensor.fiber_velocity")
        assert muscle == pytest.approx(fiber - (stored[-1] - stored[0]), rel=0.01)
        assert np.abs(made["restrictor.deviation"]).max() < 1e-6
    # What is left is the step's: half of it leaves half.
    assert errors[1] == pytest.approx(errors[0] / 2, rel=0.1)


# What a search from the middle of the bounds found (seed 1, 480 evaluations), rounded.
TUNED = [26e3, 0.12, 0.3804, 0.05, 4.377, 0.01]


def test_the_middle_of_the_bounds_hops_recurringly() -> None:
    made = simulator(LEG)
    assert made.model.start == pytest.approx([(free.low + free.high) / 2 for free in made.model.free])
    outcome = made.run()
    assert outcome.score is not None and -0.2 < outcome.score < -0.1
    assert outcome.metrics["hop.hops"] >= 10
    assert outcome.metrics["hop.spread"] < 0.001


@pytest.mark.parametrize("step", ["0.5 ms", "0.25 ms"])
def test_a_tuned_leg_hops_higher_also_at_half_its_step(step: str) -> None:
    outcome = simulator(LEG, [("simulate.step", step)]).run(TUNED)
    assert outcome.score == pytest.approx(-0.474, abs=0.004)
    assert outcome.metrics["hop.hops"] >= 5
    assert outcome.metrics["hop.spread"] < 0.01
    assert outcome.metrics["stored"] < 0.001


def test_a_weak_muscle_is_a_graded_failure() -> None:
    runner = simulator(LEG)
    scores = []
    for gain in (1.0, 1.3, 2.0):
        candidate = list(runner.model.start)
        candidate[[free.address for free in runner.model.free].index("feedback.gain")] = gain
        candidate[0] = 18e3
        outcome = runner.run(candidate)
        assert outcome.status in ("completed", "stopped")
        assert outcome.score is not None
        scores.append(outcome.score)
    assert all(np.isfinite(scores))


def preloaded(runner: Simulator) -> Sequence[float]:
    """A start with the knee bent so far that the passive fiber strains the tendon."""
    wanted = {"knee_angle": np.radians(116), "extensor.tendon_slack_length": 0.4}
    return [wanted.get(free.address, free.start) for free in runner.model.free]


def test_energy_stored_at_the_start_is_taken_off() -> None:
    counted, ignored = (simulator(PRELOAD, [("objective.correction", share)]) for share in ("1", "0"))
    candidate = preloaded(counted)
    with_it, without = counted.run(candidate), ignored.run(candidate)
    assert with_it.metrics == without.metrics
    assert with_it.metrics["stored"] > 0.1
    assert with_it.metrics["stored.energy_at_start"] == pytest.approx(
        with_it.metrics["stored"] * 80 * 0.8245 * 9.81, rel=1e-9
    )
    if without.score is not None and without.score < 0:
        assert with_it.score == pytest.approx(without.score + with_it.metrics["stored"])
    # It does lift the first hop, which is why a search would use it.
    plain = counted.run(recorded=True).trajectory
    loaded = counted.run(candidate, recorded=True).trajectory
    assert plain is not None and loaded is not None
    assert loaded["guide.position"].max() > plain["guide.position"].max() + 0.1


@pytest.mark.parametrize(
    ("address", "component", "more"),
    [
        ("ground", "contact/mujoco", [("ground.radius", "2 cm")]),
        ("extensor", "muscle/geyer2003", [("extensor.width", "0.4")]),
    ],
)
def test_one_line_swaps_a_part(tmp_path: Path, address: str, component: str, more: list[tuple[str, str]]) -> None:
    swapped = model(LEG, [(f"{address}.use", component), *more, ("simulate.duration", "0.5 s")])
    outcome = Simulator(swapped).run()
    assert outcome.status in ("completed", "stopped"), outcome.reason
