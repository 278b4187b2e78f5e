"""How a deviation of a walk in space grows from touchdown to touchdown: `python bench/orbit.py`.

The start is turned by 2 and 5 mrad in roll, to both sides. At each touchdown six numbers of the walk
(`touchdowns.py`) are compared with those of the undisturbed one. It draws docs/pictures/scone_growth.png and prints the
factor per step.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from touchdowns import SCALES, touchdowns

from gaitsim.simulation.run import Simulator
from gaitsim.study.opening import Opening

ROOT = Path(__file__).resolve().parents[1]
SPEC = ROOT / "specs" / "walking_scone_h1922.yaml"
SPHERES = ("heel", "lateral_toe", "medial_toe")
CASES: Mapping[str, Sequence[str]] = {
    "at 0.5 ms": (),
    "at 0.25 ms": ("simulate.step=0.25 ms",),
    "at 1 ms": ("simulate.step=1 ms",),
    "contacts twice as damped": [f"leg.{name}.dissipation=2 s/m" for name in SPHERES],
    "contacts twice as stiff": [f"leg.{name}.stiffness=11006.4 N^(2/3)/m" for name in SPHERES],
    "half the delay of balance": ("leg.balance_delay=25 ms",),
}
TURNS = (-5e-3, -2e-3, 2e-3, 5e-3)  # rad
STEPS = 10


def deviations(settings: Sequence[str]) -> Any:
    """The size of the deviation after each touchdown, as the geometric mean over all starts."""
    model = Opening(SPEC, ("simulate.duration=8 s", *settings)).open().model()
    simulator, start = Simulator(model), np.array(model.start)
    roll = [free.address for free in model.free].index("initial.root.roll")
    tables = []
    for turn in (0.0, *TURNS):
        x = start.copy()
        x[roll] += turn
        found = simulator.run(x.tolist(), recorded=True).trajectory
        assert found is not None
        tables.append(touchdowns(found)[1 : STEPS + 1])
    return sizes(tables[0], tables[1:])


def sizes(walk: Any, others: Sequence[Any]) -> Any:
    """How far walks are from the first one after each touchdown that all of them have: the geometric mean of norms."""
    length = min(map(len, (walk, *others)))
    norms = [np.linalg.norm((other[:length] - walk[:length]) / SCALES, axis=1) for other in others]
    return np.exp(np.mean(np.log(norms), axis=0))


def factor(deviation: Any) -> float:
    """The factor by which a deviation grows from one touchdown to the next."""
    return float(np.exp(np.polyfit(np.arange(len(deviation)), np.log(deviation), 1)[0]))


def main() -> None:
    """Draw and print."""
    import matplotlib.pyplot as plt

    figure, panel = plt.subplots(figsize=(6, 3.6), layout="constrained")
    for name, settings in CASES.items():
        found = deviations(settings)
        growth = f"{factor(found):.2f} per step"
        print(f"{name}: {growth}, {len(found)} steps", flush=True)
        panel.semilogy(np.arange(2, len(found) + 2), found, "o-", ms=3, lw=1, label=f"{name}: x {growth}")
    panel.set(xlabel="touchdown", ylabel="deviation from the undisturbed walk")
    panel.legend(frameon=False, fontsize=8, loc="lower left", bbox_to_anchor=(0, 1), ncols=2)
    panel.spines[["top", "right"]].set_visible(False)
    figure.savefig(ROOT / "docs" / "pictures" / "scone_growth.png", dpi=110)


if __name__ == "__main__":
    main()
