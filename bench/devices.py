"""The walker's cost over the stiffness of its ankle springs, as a table and a figure: python bench/devices.py."""

from __future__ import annotations

from pathlib import Path

from matplotlib.figure import Figure

import gaitsim

ROOT = Path(__file__).parents[1]
SPEC = ROOT / "specs" / "walking_geyer2010_ankle_spring.yaml"
PICTURE = ROOT / "docs" / "pictures" / "ankle_spring.png"
SLACK = (90, 95, 100)  # deg
HUMAN = (180, -7.2)  # N m/rad, % of metabolic rate at a given speed (Collins, Wiggin & Sawicki 2015)

Row = tuple[float, float, float, float]  # N m/rad, m/s, J/(kg m), W/kg


def rows(slack: float) -> list[Row]:
    """What the study finds at a slack angle in deg."""
    table = gaitsim.run(SPEC, {"exo.slack_angle": f"{slack} deg"}, save=False).table()
    if not (table["status"] == "completed").all() or table["fall_time.fell"].any():
        raise SystemExit(f"slack at {slack} deg: a walker fell, so its cost means nothing")
    stiffness = [float(text.split()[0]) for text in table["exo.stiffness"]]
    columns = (table["speed"], table["cost_of_transport"], table["cost_of_transport.rate"])
    return list(zip(stiffness, *columns, strict=True))


def main() -> None:
    figure = Figure(figsize=(7, 3.6), layout="constrained")
    left, right = figure.subplots(1, 2)
    print("| slack angle | stiffness | speed | cost of transport | metabolic rate |\n|---|---|---|---|---|")
    for slack in SLACK:
        found = rows(slack)
        _, _, first_cost, first_rate = found[0]
        for stiffness, speed, cost, rate in found:
            less, slower = 100 * (cost / first_cost - 1), 100 * (rate / first_rate - 1)
            said = f"{cost:.2f} J/(kg m), {less:+.1f} % | {rate:.2f} W/kg, {slower:+.1f} %"
            print(f"| {slack} deg | {stiffness:g} N m/rad | {speed:.2f} m/s | {said} |")
        stiffnesses = [row[0] for row in found]
        left.plot(
            stiffnesses, [100 * (row[2] / first_cost - 1) for row in found], "o-", label=f"slack from {slack} deg"
        )
        right.plot(stiffnesses, [row[1] for row in found], "o-")
    left.plot(*HUMAN, "k*", markersize=10, label="people, Collins et al. (2015)")
    left.axhline(0, color="0.7", linewidth=0.8)
    left.set(xlabel="stiffness [N m/rad]", ylabel="change of the metabolic cost [%]")
    right.set(xlabel="stiffness [N m/rad]", ylabel="speed [m/s]")
    left.legend(fontsize="small")
    figure.savefig(PICTURE, dpi=120)


if __name__ == "__main__":
    main()
