"""Energy balances: what is stored, what was supplied and lost, and the residual."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from gaitsim.analysis.drawings.drawing import Drawing
from gaitsim.analysis.drawings.style import GREY, PALETTE, above, labelled, panels
from gaitsim.analysis.gait.joint_moments import STOPS
from gaitsim.analysis.gait.path_work import created_power
from gaitsim.analysis.muscles.figures import muscles, work_done
from gaitsim.analysis.replays.cycles import Floats, sent, shade_stance, shown_part, stance, thinned
from gaitsim.analysis.replays.replay import Replay
from gaitsim.model import Part
from gaitsim.units import parse_unit

_CYCLES = 6  # more lines cannot be distinguished
_LEAST = 1e-9  # J; smaller energies get no colour of their own
_SHOWN = 6  # a longer legend leaves no room for the curves
CREATED = "created at paths"


@dataclass(frozen=True)
class Balance:
    """Energies in J over time.

    Attributes:
        stored: Stored energies by name.
        exchanged: Energies supplied since the first instant, by name; losses are negative. They explain the change of
            the total up to the residual.
    """

    stored: Mapping[str, Floats]
    exchanged: Mapping[str, Floats]

    @property
    def total(self) -> Floats:
        return np.asarray(sum(self.stored.values()), dtype=np.float64)

    @property
    def change(self) -> Floats:
        return self.total - self.total[:1]

    @property
    def residual(self) -> Floats:
        """The change of the total that no part explains, in J."""
        return self.change - sum(self.exchanged.values(), start=np.zeros_like(self.total))

    @property
    def turned_over(self) -> float:
        """The largest range of any energy in the balance, with which the residual is compared."""
        swings = [float(np.ptp(values)) for values in (*self.stored.values(), *self.exchanged.values())]
        return max(swings, default=0.0)


def balance(replay: Replay) -> Balance | None:
    """The energy balance of a run; None if no part reports kinetic and potential energy."""
    sensor = next((p for p in replay.model.parts if {"kinetic", "potential"} <= p.type.outputs.keys()), None)
    if sensor is None or not len(replay.times):
        return None
    signal = replay.trajectory
    stored = {"kinetic": signal[f"{sensor.address}.kinetic"], "potential": signal[f"{sensor.address}.potential"]}
    exchanged: dict[str, Floats] = {}
    for muscle in muscles(replay):
        stored[f"elastic, {muscle.address}"] = muscle.elastic_energy
        exchanged[f"{muscle.address}, contractile"] = muscle.contractile_work
    for part in replay.model.parts:
        held, given = _of_part(replay, part)
        stored |= {f"elastic, {name}": energy for name, energy in held.items()}
        exchanged |= given
    exchanged[CREATED] = _integral(created_power(replay), replay.times)
    return Balance(_worth(stored), _worth(exchanged))


def _worth(energies: Mapping[str, Floats]) -> dict[str, Floats]:
    return {name: values for name, values in energies.items() if np.abs(values).max(initial=0.0) > _LEAST}


def _of_part(replay: Replay, part: Part) -> tuple[dict[str, Floats], dict[str, Floats]]:
    """What a contact, a constraint or a joint stores and supplies."""
    own, signal = part.address, replay.trajectory
    if part.type.kind == "contact":
        energy = signal[f"{own}.energy"]
        if "height" not in part.type.outputs:
            return {own: energy}, {}
        return {own: energy}, {f"{own}, damping": _work_of_contact(replay, part) + energy - energy[:1]}
    if part.type.kind == "constraint":
        return {own: signal[f"{own}.energy"]}, {}
    if part.type.kind == "joint":
        return _of_joint(replay, part)
    if part.type.kind == "device":
        return _of_device(replay, part)
    return {}, {}


def _of_device(replay: Replay, part: Part) -> tuple[dict[str, Floats], dict[str, Floats]]:
    """What a device stores, and what it supplies beyond that: work of a motor, or losses, which are negative."""
    own, signal = part.address, replay.trajectory
    work = np.zeros(len(replay.times))
    for connection in replay.model.connections:
        if connection.sender.rpartition(".")[0] == own:
            joint = next((p for p in replay.model.parts if p.address == connection.target.rpartition(".")[0]), None)
            if joint is not None and joint.type.kind == "joint" and (rate := _rate(joint)):
                work = work + _integral(np.nan_to_num(sent(replay, connection)) * signal[rate], replay.times)
    if "elastic_energy" not in part.type.outputs:
        return {}, {own: work}
    energy = signal[f"{own}.elastic_energy"]
    return {own: energy}, {own: work + energy - energy[:1]}


def _rate(joint: Part) -> str:
    """The address of a joint's velocity; empty if it has none or several."""
    rates = [name for name, port in joint.type.outputs.items() if port.unit in ("m/s", "rad/s")]
    return f"{joint.address}.{rates[0]}" if len(rates) == 1 else ""


def _work_of_contact(replay: Replay, part: Part) -> Floats:
    own, signal, times = part.address, replay.trajectory, replay.times
    if "applied_force" in part.type.outputs:
        return _applied(replay, f"{own}.applied_force", f"{own}.velocity") + _applied(
            replay, f"{own}.applied_friction_force", f"{own}.slip_velocity"
        )
    height = next(name for name in ("place_height", "center_height", "height") if name in part.type.outputs)
    done = work_done(-signal[f"{own}.force"], signal[f"{own}.{height}"])
    for force, slip in (("friction_force", "slip_velocity"), ("side_force", "side_slip_velocity")):
        if slip in part.type.outputs:
            done = done + _integral(signal[f"{own}.{force}"] * signal[f"{own}.{slip}"], times)
    return done


def _applied(replay: Replay, force: str, velocity: str) -> Floats:
    """The work of a force that is constant within each step and reported at the end of the step."""
    signal = replay.trajectory
    rate = signal[velocity]
    steps = signal[force][1:] * 0.5 * (rate[1:] + rate[:-1]) * np.diff(replay.times)
    return np.concatenate([np.zeros(min(1, len(rate))), np.cumsum(steps)])


def _of_joint(replay: Replay, part: Part) -> tuple[dict[str, Floats], dict[str, Floats]]:
    """Stops, damping and drives of a joint with one velocity. Moments of muscle paths count as the muscles', those of
    devices as the devices'."""
    own, outputs, rate = part.address, part.type.outputs, _rate(part)
    if not rate:
        return {}, {}
    signal, velocity = replay.trajectory, replay.trajectory[rate]
    held: dict[str, Floats] = {}
    given: dict[str, Floats] = {}
    drives = [name for name, port in part.type.inputs.items() if parse_unit(port.unit).si in ("N", "N m")]
    for drive in drives:
        kinds = {p.address: p.type.kind for p in replay.model.parts}
        senders = [c for c in replay.model.connections if c.target == f"{own}.{drive}"]
        others = [c for c in senders if kinds[c.sender.rpartition(".")[0]] not in ("path", "device")]
        if others:
            moment = sum((np.nan_to_num(sent(replay, each)) for each in others), np.zeros(len(replay.times)))
            given[f"{own}, {drive}"] = _integral(moment * velocity, replay.times)
    damping = 0.0
    if "damping" in part.numbers:
        damping = replay.model.values()[part.numbers["damping"]]
    lost = _integral(-damping * velocity**2, replay.times)
    stop = next((name for name in STOPS if name in outputs), None)
    if stop is not None and "stop_energy" in outputs:
        held[f"{own}'s stops"] = energy = signal[f"{own}.stop_energy"]
        lost = lost + _integral(signal[f"{own}.{stop}"] * velocity, replay.times) + energy - energy[:1]
    return held, given | {f"{own}, damping": lost}


def _integral(power: Floats, times: Floats) -> Floats:
    steps = 0.5 * (power[1:] + power[:-1]) * np.diff(times)
    return np.concatenate([np.zeros(min(1, len(power))), np.cumsum(steps)])


def energy_figures(replay: Replay) -> list[Drawing]:
    """The stored energies of the last cycles, stacked, and the supplied energies over the run."""
    whole = balance(replay)
    if whole is None or len(replay.times) < 2:
        return []
    part, period = shown_part(replay)
    return [_stacked(replay, whole, part, period), _exchanged(replay, whole)]


def _largest(energies: Mapping[str, Floats]) -> dict[str, Floats]:
    """The energies with the largest range, in their order, and the sum of all others."""
    if len(energies) <= _SHOWN:
        return dict(energies)
    by_swing = sorted(energies, key=lambda name: (name != CREATED, -float(np.ptp(energies[name]))))
    chosen = by_swing[: _SHOWN - 1]
    found = {name: values for name, values in energies.items() if name in chosen}
    others = [values for name, values in energies.items() if name not in chosen]
    return found | {f"{len(others)} others": np.sum(others, axis=0)}


def _stacked(replay: Replay, whole: Balance, part: Replay, period: str) -> Drawing:
    times = part.times
    inside = (replay.times >= times[0]) & (replay.times <= times[-1])
    instants = np.linspace(0, len(times) - 1, min(len(times), 1200)).astype(int)
    lowest = whole.stored["potential"][inside].min() if "potential" in whole.stored else 0.0
    layers = {name: values[inside] - (lowest if name == "potential" else 0.0) for name, values in whole.stored.items()}
    layers = _largest(layers)
    figure, (axes,) = panels(1, 1, height=3.2)
    stack = [values[instants] for values in layers.values()]
    axes.stackplot(times[instants], stack, labels=list(layers), colors=PALETTE[:_SHOWN], alpha=0.75, linewidth=0)
    axes.plot(times[instants], np.sum(stack, axis=0), color="black", linewidth=1.2, label="total")
    shade_stance(axes, part)
    axes.margins(x=0)
    axes.set_ylim(bottom=0)
    axes.set_xlabel(labelled("time", "s"))
    axes.set_ylabel(labelled("energy", "J"))
    above(axes)
    grey = " Grey: stance." if stance(part) is not None else ""
    caption = (
        f"All energy that the model holds, over {period}; the layers sum to the total. Potential energy counts from "
        f"its least value in this time ({lowest:.5g} J).{grey}"
    )
    return Drawing("energies", "Stored energies", caption, figure)


def _exchanged(replay: Replay, whole: Balance) -> Drawing:
    times, residual = replay.times, whole.residual
    part, period = shown_part(replay, _CYCLES)
    inside = (times >= part.times[0]) & (times <= part.times[-1])
    figure, (axes, rest) = panels(2, 1, height=2.3)
    exchanged = _largest(whole.exchanged)
    for name, values in exchanged.items():
        axes.plot(*thinned(times[inside], values[inside]), label=name)
    axes.plot(*thinned(times[inside], whole.change[inside]), "--", color="black", label="change of the total")
    axes.set_ylabel(labelled("energy since the start", "J"))
    above(axes)
    rest.plot(*thinned(times, residual), color=GREY)
    rest.set_ylabel(labelled("residual", "J"))
    for panel in (axes, rest):
        panel.set_xlabel(labelled("time", "s"))
        panel.margins(x=0)
    ends = ", ".join(f"{name} {values[-1]:+.4g} J" for name, values in exchanged.items())
    largest = float(np.abs(residual).max())
    share = f", {100 * largest / whole.turned_over:.2g} % of the largest swing" if whole.turned_over > 0 else ""
    paths = ""
    if CREATED in whole.exchanged:
        paths = " Created at paths: joints get more work from them than muscle-tendon units give, or less, as the "
        paths += "pennation factor scales a path's length and not its moment."
    caption = (
        f"What came into the model since the start, losses negative, over {period}; at the end: {ends or 'nothing'}; "
        f"the total changed by {whole.change[-1]:+.4g} J. Residual, which is what these do not explain (errors of the "
        f"time step, and parts that take energy without saying so): {residual[-1]:+.3g} J at the end, at most "
        f"{largest:.3g} J{share}.{paths}"
    )
    return Drawing("energy_balance", "Who gave and who took energy", caption, figure)
