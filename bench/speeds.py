"""The walkers tuned for five speeds, at their step and half of it, as a table and a figure; and the speed over time of
the one that changes it within a run: python bench/speeds.py.
"""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from matplotlib.figure import Figure

import gaitsim

ROOT = Path(__file__).parents[1]
PICTURES = ROOT / "docs" / "pictures"
SPEEDS = (0.8, 1.0, 1.2, 1.4, 1.6)  # m/s
CHANGING = ROOT / "specs" / "walking_changing_speed.yaml"
STEPS = ("2 ms", "1 ms")
METRICS = {
    "cost_of_transport": "cost of transport [J/(kg m)]",
    "step_length": "step length [m]",
    "cadence": "cadence [1/min]",
}
# Means of adults over ground (Fukuchi, Fukuchi & Duarte 2018) at slow, comfortable and fast speed.
PEOPLE = {"step_length": (0.57, 0.65, 0.68), "cadence": (97.9, 114.7, 132.3)}
PEOPLE_AT = (0.94, 1.24, 1.50)  # m/s


def ralston(speed: np.ndarray) -> np.ndarray:
    """Gross cost of transport of people in J/(kg m): 29 + 0.0053 v^2 cal/(min kg), v in m/min (Ralston 1958)."""
    per_minute = 60 * speed
    return 4.184 * (29 / per_minute + 0.0053 * per_minute)


def name(speed: float) -> str:
    """The spec of a speed."""
    return f"walking_at_{speed:.1f}".replace(".", "p")


def row(speed: float, step: str) -> dict[str, float]:
    """The metrics of the walker of a speed."""
    (outcome,) = gaitsim.run(ROOT / "specs" / f"{name(speed)}.yaml", {"simulate.step": step}, save=False).outcomes
    if outcome.metrics["fall_time.fell"]:
        raise SystemExit(f"{name(speed)} at {step}: it fell, so its numbers mean nothing")
    return dict(outcome.metrics)


def kept(speed: float) -> dict[str, float]:
    """The metrics of the walker that can change its speed, if one speed is asked for, after 12 s."""
    values = {
        "asked_speed.times": "[0 s, 4 s, 8 s, 40 s]",
        "asked_speed.values": f"[1.2 m/s, 1.2 m/s, {speed} m/s, {speed} m/s]",
    }
    late = {f"{measure}.settle": "12 s" for measure in ("speed", "cost_of_transport", "step_length", "cadence")}
    (outcome,) = gaitsim.run(CHANGING, values | late | {"simulate.duration": "40 s"}, save=False).outcomes
    if outcome.metrics["fall_time.fell"]:
        raise SystemExit(f"asked for {speed} m/s it fell")
    return dict(outcome.metrics)


def over_speed() -> None:
    """The table, and the figure over speed."""
    figure = Figure(figsize=(9, 3.5), layout="constrained")
    panels = dict(zip(METRICS, figure.subplots(1, 3), strict=True))
    print("| target | speed | cost of transport | step length | cadence | stance | knee flexion |\n" + "|---" * 7 + "|")
    found = {step: [row(speed, step) for speed in SPEEDS] for step in STEPS}
    for target, *both in zip(SPEEDS, *found.values(), strict=True):
        cells = [
            ", ".join(f"{scale * one[key]:{form}}" for one in both) + f" {unit}"
            for key, scale, form, unit in (
                ("speed", 1, ".3f", "m/s"),
                ("cost_of_transport", 1, ".2f", "J/(kg m)"),
                ("step_length", 100, ".1f", "cm"),
                ("cadence", 1, ".1f", "1/min"),
                ("stance_fraction", 100, ".1f", "%"),
                ("peak_knee_flexion", 1, ".1f", "deg"),
            )
        ]
        print(f"| {target} m/s | {' | '.join(cells)} |")
    rows = found[STEPS[0]]
    steady = [kept(speed) for speed in np.round(np.arange(0.8, 1.65, 0.1), 1)]
    for metric, axes in panels.items():
        axes.plot([one["speed"] for one in rows], [one[metric] for one in rows], "o-", label="tuned for each speed")
        axes.plot(
            [one["speed"] for one in steady], [one[metric] for one in steady], ".-", label="one that can change it"
        )
        if metric in PEOPLE:
            axes.plot(PEOPLE_AT, PEOPLE[metric], "k*--", label="people, Fukuchi et al. (2018)")
        else:
            speeds = np.linspace(0.7, 1.7, 50)
            axes.plot(speeds, ralston(speeds), "k--", label="people, Ralston (1958)")
            axes.set_ylim(bottom=0)
        axes.set(xlabel="speed [m/s]", ylabel=METRICS[metric])
        axes.legend(fontsize="small", loc="lower center", bbox_to_anchor=(0.5, 1), frameon=False)
    figure.savefig(PICTURES / "speeds.png", dpi=120)


def over_time() -> None:
    """The figure of the speed within one run."""
    with TemporaryDirectory() as folder:
        file = Path(folder) / "run.csv"
        gaitsim.run(CHANGING, out=file, every="20 ms", save=False)
        table = np.genfromtxt(file, delimiter=",", names=True, deletechars="")
    figure = Figure(figsize=(7, 3), layout="constrained")
    axes = figure.subplots()
    columns = {column.partition("[")[0].strip("_ "): column for column in table.dtype.names or ()}
    time, began = table[columns["time"]], table[columns["stride_speed.speed"]] > 0
    axes.plot(time, table[columns["root.forward_velocity"]], color="0.8", linewidth=0.6, label="hip")
    axes.plot(time, table[columns["asked_speed.value"]], "k--", label="asked for")
    axes.plot(time[began], table[columns["stride_speed.speed"]][began], label="mean of the last stride")
    axes.set(xlabel="time [s]", ylabel="speed [m/s]")
    axes.legend(fontsize="small", loc="lower center", bbox_to_anchor=(0.5, 1), frameon=False, ncols=3)
    figure.savefig(PICTURES / "changing_speed.png", dpi=120)


if __name__ == "__main__":
    over_speed()
    over_time()
