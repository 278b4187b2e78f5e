"""Orders of the integrators: `python bench/integrators.py` prints docs/numerics.md's table.

The error of a signal at one instant, against rk4 at a sixteenth of the smallest step; its order is the binary
logarithm of how the error falls as the step is halved. And how much of its energy a model without friction gains
or loses in 100 s at 1 ms.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.table import Table

from gaitsim.components.find import Library, library_folders
from gaitsim.simulation.outcome import Trajectory
from gaitsim.simulation.run import Simulator
from gaitsim.spec.resolve import read_spec, resolve

ROOT = Path(__file__).resolve().parents[1]
TESTS = ROOT / "tests" / "simulation" / "specs"
SCHEMES = ("euler", "rk4")
LONG = 100.0  # s


@dataclass(frozen=True)
class Case:
    """A spec, the signal that is compared, when (s), at which steps (s), and how stored energy is summed (J)."""

    spec: Path
    signal: str
    instant: float
    steps: tuple[float, ...]
    spring: float = 0.0

    def energy(self, found: Trajectory) -> float:
        """Change of the energy over a run; a spring of 30 deg belongs to the model of the tests."""
        turned = found[self.signal] - np.radians(30)
        return float(np.ptp(found["energy.total"] + 0.5 * self.spring * turned**2))


MILLI = (4e-3, 2e-3, 1e-3)
CASES: Mapping[str, Case] = {
    "double pendulum": Case(TESTS / "double_pendulum.yaml", "hip.angle", 0.4, MILLI),
    "free flight": Case(TESTS / "free_flight.yaml", "hip.angle", 0.4, MILLI),
    "pendulum on a spring": Case(TESTS / "spring_pendulum.yaml", "pivot.angle", 0.4, MILLI, 60.0),
    "published hopper": Case(ROOT / "specs" / "hopping_geyer2003.yaml", "guide.position", 0.15, (2e-4, 1e-4, 5e-5)),
}


def run(case: Case, scheme: str, step: float, duration: float) -> Trajectory:
    """A recorded run."""
    settings = {"integrator": scheme, "step": f"{step:.12g} s", "duration": f"{duration} s"}
    spec = read_spec(case.spec, [(f"simulate.{name}", value) for name, value in settings.items()])
    found = Simulator(resolve(spec, Library(library_folders(case.spec)), case.spec.stem)).run(recorded=True)
    assert found.trajectory is not None, found.reason
    return found.trajectory


def at(case: Case, scheme: str, step: float) -> float:
    """The signal at its instant."""
    return float(run(case, scheme, step, case.instant + 2 * step)[case.signal][round(case.instant / step)])


def main() -> None:
    """Print the table."""
    table = Table("model", "integrator", *("error at step", "half", "quarter"), "order", "energy in 100 s at 1 ms")
    for name, case in CASES.items():
        exact = at(case, "rk4", case.steps[-1] / 16)
        for scheme in SCHEMES:
            errors = [abs(at(case, scheme, step) - exact) for step in case.steps]
            orders = np.log2(np.divide(errors[:-1], errors[1:]))
            energy = "-"
            if case.spec.parent == TESTS and "flight" not in name:
                energy = f"{case.energy(run(case, scheme, 1e-3, LONG)):.2g} J"
            table.add_row(name, scheme, *(f"{e:.2g}" for e in errors), ", ".join(f"{o:.1f}" for o in orders), energy)
    Console(width=150).print(table)


if __name__ == "__main__":
    main()
