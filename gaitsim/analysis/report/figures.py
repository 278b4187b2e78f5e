"""The list of all functions that make figures. Each returns none for a run that it does not apply to."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from gaitsim.analysis.drawings.drawing import Drawing, Figures
from gaitsim.analysis.gait.figures import gait_figures, lacking_gait
from gaitsim.analysis.gait.overlay import gait_overlays
from gaitsim.analysis.hopping.figures import hopping_figures
from gaitsim.analysis.muscles.energies import balance, energy_figures
from gaitsim.analysis.muscles.figures import muscle_figures
from gaitsim.analysis.replays.replay import Replay
from gaitsim.analysis.searches.convergence import convergence_figures, tuned_figures
from gaitsim.analysis.searches.draws import draws_figures
from gaitsim.analysis.searches.limits import limit_figures
from gaitsim.analysis.searches.sweep import sweep_figures
from gaitsim.analysis.signals.motion import motion_figures
from gaitsim.analysis.signals.plots import signal_overlays

FIGURES: tuple[Figures, ...] = (
    limit_figures,
    sweep_figures,
    draws_figures,
    convergence_figures,
    tuned_figures,
    hopping_figures,
    gait_figures,
    energy_figures,
    muscle_figures,
    motion_figures,
)

# Of several runs over one another.
OVERLAYS: tuple[Callable[[Sequence[Replay]], list[Drawing]], ...] = (gait_overlays, signal_overlays)


def missing(replay: Replay) -> list[str]:
    """The figures that a run lacks, with the reasons, for the reader."""
    count = len(replay.times)
    if count < 2:
        instants = "one instant only" if count else "no instant"
        why = f"; it {replay.ending}" if replay.ending else ""
        return [f"{replay.label} has {instants}, so nothing is drawn over time{why}."]
    found = lacking_gait(replay)
    if balance(replay) is None:
        move = "add energy: {use: sensor/mechanical_energy} to its parts"
        found.append(f"{replay.label} reports no kinetic and potential energy, so none is drawn; {move}.")
    return found
