"""What walkers in space do beside people, at their step and at half of it: `python bench/space.py [SPEC ...]`.

It prints a table in Markdown for each. People's ranges lie around one adult at 1.24 m/s (Rajagopal et al. 2016) and
the normal curves of a gait laboratory; they are wide enough for other speeds of walking. An asterisk is beside what is
outside.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from gaitsim.model import Model
from gaitsim.simulation.run import Simulator
from gaitsim.study.opening import Opening
from gaitsim.units import parse_unit

SPECS = Path(__file__).resolve().parents[1] / "specs"
BOTH = [SPECS / "walking_scone_h1922.yaml", SPECS / "walking_song2015.yaml"]


@dataclass(frozen=True)
class Measure:
    """How a metric is shown: in words, in a unit, beside the range of people, if one is known."""

    said: str
    unit: str
    low: float = -math.inf
    high: float = math.inf

    def shown(self, value: float, unit: str) -> str:
        """A value in a metric's own unit, as a cell of the table."""
        if math.isnan(value):
            return "-"
        found = value * parse_unit(unit).factor / parse_unit(self.unit).factor
        outside = "" if self.low <= found <= self.high else "*"
        return f"{found:.3g}{outside}"

    @property
    def people(self) -> str:
        """The range of people, as a cell of the table."""
        return "" if math.isinf(self.low) else f"{self.low:g} to {self.high:g}"


# By metric; a model without a pelvis of its own measures its trunk.
MEASURES: Mapping[str | tuple[str, str], Measure] = {
    "fall_time": Measure("upright, s", "s"),
    "speed": Measure("speed, m/s", "m/s", 1.0, 1.5),
    "cadence": Measure("cadence, 1/min", "1/min", 95, 125),
    "step_length": Measure("step length, cm", "cm", 55, 80),
    "step_width": Measure("step width, cm", "cm", 7, 18),
    "stance_fraction": Measure("stance, %", "%", 58, 67),
    "stance_fraction.double_support": Measure("double support, %", "%", 16, 32),
    "force_peaks_r.first": Measure("first peak of the vertical force, body weights", "1", 1.0, 1.25),
    "force_peaks_r.second": Measure("second peak", "1", 1.0, 1.25),
    "medial_load.high": Measure("largest medial force, body weights", "1", 0.03, 0.09),
    ("pelvic_obliquity", "trunk_obliquity"): Measure("obliquity of the pelvis, range, deg", "deg", 4, 12),
    ("pelvic_rotation", "trunk_rotation"): Measure("rotation of the pelvis, range, deg", "deg", 4, 14),
    ("hip_adduction", "hip_abduction"): Measure("hip adduction, range, deg", "deg", 8, 18),
    "sway": Measure("center of mass to the side, range, cm", "cm", 3, 6),
    "peak_knee_flexion": Measure("knee flexion in swing, deg", "deg", 55, 70),
    "lateral_margin": Measure("lateral margin of stability, mean, cm", "cm"),
    "lateral_margin.lowest": Measure("and smallest, cm", "cm"),
    "correlation_hip": Measure("correlation with people: hip flexion", "1", 0.9, 1),
    "correlation_knee": Measure("knee", "1", 0.9, 1),
    "correlation_ankle": Measure("ankle", "1", 0.8, 1),
    "cost_of_transport": Measure("gross cost of transport, J/(kg m)", "J/(kg m)", 2.5, 4.5),
}


def cells(model: Model) -> list[str]:
    """What one run does, in the order of the measures."""
    found, units, shown = Simulator(model).run().metrics, model.metrics, []
    for names, one in MEASURES.items():
        known = [name for name in ((names,) if isinstance(names, str) else names) if name in units]
        shown.append(one.shown(found.get(known[0], math.nan), units[known[0]]) if known else "-")
    return shown


def table(spec: Path) -> str:
    """The table of one walker."""
    model = Opening(spec).open().model()
    step = model.simulate.step * 1e3
    halved = Opening(spec, (f"simulate.step={step / 2:g} ms",)).open().model()
    lines = [f"| {spec.stem} | at {step:g} ms | at {step / 2:g} ms | people |", "|---|---|---|---|"]
    for measure, now, half in zip(MEASURES.values(), cells(model), cells(halved), strict=True):
        lines.append(f"| {measure.said} | {now} | {half} | {measure.people} |")
    return "\n".join(lines)


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("specs", nargs="*", type=Path, default=BOTH)
    print("\n\n".join(table(spec) for spec in parser.parse_args().specs))


if __name__ == "__main__":
    main()
