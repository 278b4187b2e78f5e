"""Figures of muscles: excitations, signals over time, and work loops."""

from __future__ import annotations

from dataclasses import dataclass
from fnmatch import fnmatchcase
from typing import TYPE_CHECKING, Any

import numpy as np

from gaitsim.analysis.drawings.drawing import Drawing
from gaitsim.analysis.drawings.style import FONT, GREY, PALETTE, above, labelled, panels
from gaitsim.analysis.muscles.overview import overview_figures
from gaitsim.analysis.replays.cycles import Floats, arriving, last_cycles, shade_stance, shown_part, thinned
from gaitsim.analysis.replays.replay import Replay

if TYPE_CHECKING:
    from matplotlib.axes import Axes


_MANY = 4  # a model with more muscles gets overviews


@dataclass(frozen=True)
class Muscle:
    """The signals of one muscle, in SI."""

    address: str
    force: Floats
    fiber_length: Floats
    optimal_fiber_length: float
    path_length: Floats
    activation: Floats
    stimulation: Floats
    elastic_energy: Floats

    @property
    def contractile_work(self) -> Floats:
        """The work of the contractile element since the first instant, in J.

        It is the work of the whole unit plus the energy in its springs, for every muscle model.
        """
        return work_done(self.force, self.path_length) + self.elastic_energy - self.elastic_energy[:1]


def muscles(replay: Replay) -> list[Muscle]:
    """All muscles of a run."""
    values, found = replay.model.values(), []
    for part in replay.model.parts:
        if part.type.kind != "muscle":
            continue
        own = part.address
        inner = (p.address for p in replay.model.parts if p.type.kind == "path" and p.address.startswith(f"{own}."))
        path = next(inner, None)
        if path is None:
            continue
        found.append(
            Muscle(
                own,
                replay.trajectory[f"{own}.force"],
                replay.trajectory[f"{own}.fiber_length"],
                values[part.numbers["optimal_fiber_length"]],
                replay.trajectory[f"{path}.length"],
                replay.trajectory[f"{own}.activation"],
                arriving(replay, f"{own}.excitation"),
                replay.trajectory[f"{own}.elastic_energy"],
            )
        )
    return found


def work_done(force: Floats, length: Floats) -> Floats:
    """The work in J of a tension in N since the first instant; positive while the path shortens."""
    steps = -0.5 * (force[1:] + force[:-1]) * np.diff(length)
    return np.concatenate([np.zeros(min(1, len(force))), np.cumsum(steps)])


def net_work(force: Floats, length: Floats) -> float:
    """The work in J of a loop, which is closed by a straight line; positive if the muscle does work."""
    if len(force) < 2:
        return 0.0
    return float(work_done(np.append(force, force[0]), np.append(length, length[0]))[-1])


def muscle_figures(replay: Replay) -> list[Drawing]:
    """Two figures for each muscle: its signals over time, and its work loops. Models with many muscles get overviews
    instead.
    """
    if len(replay.times) < 2:
        return []
    addresses = [muscle.address for muscle in muscles(replay)]
    if len(addresses) > _MANY:
        return overview_figures(replay)
    return [drawing for address in addresses for drawing in figures_of(replay, address)]


def figures_of(replay: Replay, address: str) -> list[Drawing]:
    """The signals of one muscle over time, and its work loops."""
    return [_over_time(replay, address), *_loops(replay, address)]


def matching_muscles(replay: Replay, text: str) -> list[str]:
    """The addresses of the muscles that an address or a pattern such as 'leg_*.soleus' names."""
    return [muscle.address for muscle in muscles(replay) if fnmatchcase(muscle.address, text)]


def _one(replay: Replay, address: str) -> Muscle:
    return next(muscle for muscle in muscles(replay) if muscle.address == address)


def _over_time(replay: Replay, address: str) -> Drawing:
    part, period = shown_part(replay, address=address)
    muscle, times = _one(replay, address), replay.times
    inside = (times >= part.times[0]) & (times <= part.times[-1])
    figure, (drive, force, length) = panels(3, 1, height=1.7, share=True)
    for name, values, line in (("stimulation", muscle.stimulation, "--"), ("activation", muscle.activation, "-")):
        drive.plot(*thinned(times[inside], np.clip(values[inside], -0.05, 1.5)), line, label=name)
    drive.set_ylabel(labelled("drive", "1"))
    force.plot(*thinned(times[inside], muscle.force[inside]), color=PALETTE[1])
    force.set_ylabel(labelled("force", "N"))
    length.plot(*thinned(times[inside], 100 * muscle.fiber_length[inside]), color=PALETTE[2], label="fiber length")
    optimal = 100 * muscle.optimal_fiber_length
    length.axhline(optimal, color=GREY, linestyle=":", linewidth=1, label="optimal length")
    length.set_ylabel(labelled("length", "cm"))
    length.set_xlabel(labelled("time", "s"))
    shaded = [shade_stance(axes, part, address) for axes in (drive, force, length)]
    drive.margins(x=0)
    above(drive)
    above(length)
    grey = " Grey: stance." if any(shaded) else ""
    clipped = " Stimulation is drawn up to 1.5." if np.nanmax(muscle.stimulation[inside]) > 1.5 else ""
    caption = (
        f"{address} over {period}: stimulation as it arrives (the sum of all senders, before it is limited) and "
        f"activation, force in N (at most {muscle.force[inside].max():.4g} N), fiber length in cm.{grey}{clipped}"
    )
    return Drawing(f"muscle_{address}", f"Muscle {address}", caption, figure)


def _loops(replay: Replay, address: str) -> list[Drawing]:
    span = last_cycles(replay, 1, address)
    part = replay if span is None else replay.between(*span)
    muscle = _one(part, address)
    if len(muscle.force) < 2 or not np.any(muscle.force > 0):
        return []
    figure, axes = panels(2, 1, height=2.4)
    works = []
    for panel, name, length in (
        (axes[0], "fiber length", muscle.fiber_length),
        (axes[1], "length of the whole unit", muscle.path_length),
    ):
        _draw_loop(panel, 100 * length, muscle.force)
        works.append(net_work(muscle.force, length))
        panel.set_xlabel(labelled(name, "cm"))
        panel.set_ylabel(labelled("force", "N"))
        panel.set_title(f"net work {works[-1]:.3g} J", loc="left", fontsize=FONT)
    when = "over the last cycle" if span else "over the whole run, which has no full cycle"
    caption = (
        f"{address} {when}, in the sense of the arrows: force in N against the length of the fiber and of muscle and "
        f"tendon together. Net work: {works[0]:.4g} J of the fiber, {works[1]:.4g} J of the whole unit; positive if it "
        "gives more than it takes. Over a steady cycle both are equal, as a tendon keeps nothing."
    )
    return [Drawing(f"work_loop_{address}", f"Work loop of {address}", caption, figure)]


def _draw_loop(axes: Axes, lengths: Floats, forces: Floats) -> None:
    """Draw a loop with arrows along it and dots at its beginnings."""
    axes.plot(lengths, forces, color=PALETTE[0])
    axes.plot(lengths[:1], forces[:1], "o", color=PALETTE[0], markersize=4)
    width, height = np.ptp(lengths) or 1.0, np.ptp(forces) or 1.0
    way = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(lengths) / width, np.diff(forces) / height))])
    for share in (0.15, 0.4, 0.65, 0.9):
        at = int(np.searchsorted(way, share * way[-1]))
        behind = int(np.searchsorted(way, max(0.0, share * way[-1] - 0.02)))
        if behind < at < len(lengths):
            ends: dict[str, Any] = {"xy": (lengths[at], forces[at]), "xytext": (lengths[behind], forces[behind])}
            axes.annotate("", **ends, arrowprops={"arrowstyle": "-|>", "color": PALETTE[0], "mutation_scale": 12})
