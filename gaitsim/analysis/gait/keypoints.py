"""Published values of healthy adults at their natural speed, for quantities without a shipped curve: peaks of forces
and powers, and the timing of muscles.

Peaks are ranges over two means: those of Bovi and others (2011) and of Winter (1991, 19 subjects). A muscle counts as
active where the mean of Bovi and others is above half of its range.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from gaitsim.analysis.gait.panels import PEOPLE

if TYPE_CHECKING:
    from matplotlib.axes import Axes

PEAKS_BY = "Bovi and others 2011, Winter 1991"
ON_BY = "Bovi and others 2011"


@dataclass(frozen=True)
class Peak:
    """A peak of a curve over the gait cycle: value and position in %, each from the lower to the higher mean."""

    low: float
    high: float
    begin: float
    end: float


# body weights: along the ground's normal, and forwards
VERTICAL = (Peak(1.055, 1.103, 14, 14), Peak(0.721, 0.800, 29, 30), Peak(1.084, 1.142, 48, 48))
FORWARDS = (Peak(-0.196, -0.161, 10, 10), Peak(0.208, 0.223, 52, 54))

# W/kg, by joint
POWERS: Mapping[str, Sequence[Peak]] = {
    "hip": (Peak(0.275, 0.391, 11, 12), Peak(0.713, 0.754, 60, 62)),
    "knee": (Peak(-0.759, -0.567, 7, 10), Peak(-0.788, -0.778, 56, 60), Peak(-0.976, -0.785, 90, 92)),
    "ankle": (Peak(-0.600, -0.385, 36, 36), Peak(3.269, 3.331, 54, 55)),
}

# deg and N m/kg, out of the sagittal plane: between one adult at 1.24 m/s and a laboratory's mean of adults
ACROSS_BY = "one adult of Rajagopal and others 2016, and the normal curves of a gait laboratory"
ACROSS: Mapping[str, Sequence[Peak]] = {
    "pelvic obliquity": (Peak(2.7, 4.3, 18, 18), Peak(-5.5, -4.7, 68, 69)),
    "pelvic rotation": (Peak(2.5, 7.5, 16, 17), Peak(-4.6, -1.2, 72, 76)),
    "hip adduction": (Peak(3.9, 5.6, 18, 22), Peak(-12.7, -5.0, 66, 70)),
    "hip abduction moment": (Peak(0.74, 0.74, 18, 18),),  # of the laboratory
}

# from and to, in % of the gait cycle
ON: Mapping[str, Sequence[tuple[float, float]]] = {
    "tibialis_anterior": ((0, 5), (65, 74), (95, 100)),
    "soleus": ((31, 48),),
    "gastrocnemius": ((28, 45),),
    "vastus": ((0, 11), (95, 100)),
    "hamstrings": ((0, 9), (83, 100)),
    "gluteus": ((0, 7),),
}


def draw_peaks(panel: Axes, peaks: Sequence[Peak]) -> None:
    """Draw a cross for each peak, as wide and as high as its range."""
    for peak in peaks:
        at, value = (peak.begin + peak.end) / 2, (peak.low + peak.high) / 2
        wide, high = (peak.end - peak.begin) / 2, (peak.high - peak.low) / 2
        panel.errorbar(
            at, value, high, wide, color=PEOPLE, marker="o", markersize=4, capsize=2, linewidth=1.2, zorder=4
        )


def draw_on(panel: Axes, muscle: str) -> None:
    """Draw bars along the upper edge where the muscle of people is active."""
    for begin, end in ON.get(muscle, ()):
        panel.axvspan(begin, end, 0.93, 1, color=PEOPLE, linewidth=0)


def name_peaks(panel: Axes) -> None:
    """Explain the crosses in the legend."""
    panel.plot([], [], "o", color=PEOPLE, markersize=4, label="people")
