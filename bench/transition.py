"""From walking to running: `python bench/transition.py` hands the walker's state to the runner's law.

The walker walks for some seconds. At instants of one stride, its pose and velocities become the start of the runner,
whose law has other gains and other targets. Muscles and delayed signals start anew. One line an instant: how long the
body stays up, its speed at first and at last, and in how many of its last steps both feet are off the ground.
"""

from __future__ import annotations

import argparse
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from gaitsim.simulation.outcome import Outcome, Trajectory
from gaitsim.simulation.run import Simulator
from gaitsim.study.opening import Opening

SPECS = Path(__file__).resolve().parents[1] / "specs"
STANDS = 0.05  # body weights, as of both laws
JOINTS = [f"leg_{side}.{joint}" for side in "lr" for joint in ("hip", "knee", "ankle")]
HANDED = {
    **dict.fromkeys(("root.z",), "m"),
    **dict.fromkeys(("root.forward_velocity", "root.upward_velocity"), "m/s"),
    **{"root.pitch": "rad", "root.pitch_velocity": "rad/s"},
    **{f"{joint}.angle": "rad" for joint in JOINTS},
    **{f"{joint}.angular_velocity": "rad/s" for joint in JOINTS},
}


def run(spec: str, *settings: str) -> tuple[Outcome, Trajectory]:
    """A recorded run of a spec with settings such as `simulate.duration=7 s`."""
    outcome = Simulator(Opening(SPECS / spec, settings).open().model()).run(recorded=True)
    assert outcome.trajectory is not None
    return outcome, outcome.trajectory


def touchdowns(made: Trajectory, side: str) -> NDArray[np.intp]:
    """Indices of the instants in which a foot is loaded anew."""
    stands = made[f"leg_{side}.leg_load.load"] > STANDS
    return np.flatnonzero(stands[1:] & ~stands[:-1]) + 1


def handed(made: Trajectory, at: int) -> list[str]:
    """The walker's state as settings of the runner's spec."""
    values = [f"initial.{name}={made[name][at]} {unit}" for name, unit in HANDED.items()]
    return values + [f"initial.leg_{side}.phase.phase={made[f'leg_{side}.phase.phase'][at]:.0f}" for side in "lr"]


def mean_speed(made: Trajectory, begin: float, end: float) -> float:
    """Speed between two instants, in m/s."""
    first, last = np.searchsorted(made.times, (begin, end)).clip(max=made.times.size - 1)
    return float((made["root.x"][last] - made["root.x"][first]) / (made.times[last] - made.times[first]))


def flights(made: Trajectory, begin: float) -> tuple[int, int]:
    """Steps that end after an instant, and how many of them have a flight."""
    aloft = np.logical_and.reduce([made[f"leg_{side}.leg_load.load"] <= STANDS for side in "lr"])
    landings = np.sort(np.concatenate([touchdowns(made, side) for side in "lr"]))
    steps = [aloft[a:b].any() for a, b in pairwise(landings) if made.times[b] > begin]
    return len(steps), sum(steps)


def main() -> None:
    """Hand over at ten instants, or as many as asked for."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--instants", type=int, default=10, help="in one stride of the walker")
    parser.add_argument("--seconds", type=float, default=10, help="duration of each run")
    options = parser.parse_args()
    _, walk = run("walking_geyer2010.yaml", "simulate.duration=7 s")
    first, last = [at for at in touchdowns(walk, "r") if walk.times[at] > 5][:2]
    print(f"walker: {mean_speed(walk, 5, 7):.2f} m/s")
    print("% of the stride  upright (s)  first 2 s (m/s)  last 2 s (m/s)  last 3 s: steps, with flight")
    for number in range(options.instants):
        at = first + (last - first) * number // options.instants
        duration = f"simulate.duration={options.seconds} s"
        outcome, made = run("running_wang2012.yaml", duration, *handed(walk, int(at)))
        end = outcome.metrics["fall_time"]
        speeds = f"{mean_speed(made, 0, min(2, end)):15.2f}  {mean_speed(made, max(0, end - 2), end):14.2f}"
        count, with_flight = flights(made, end - 3)
        print(f"{100 * number / options.instants:15.0f}  {end:11.1f}  {speeds}  {count:21}, {with_flight}", flush=True)


if __name__ == "__main__":
    main()
