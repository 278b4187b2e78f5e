"""Panels of signals: which share one, their lines and labels, and the heading, legend and caption of a figure."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

from gaitsim.analysis.drawings import style
from gaitsim.analysis.replays.replay import Replay
from gaitsim.analysis.signals.selection import has, runs_without
from gaitsim.model import Signal

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_LINES = 4  # in one panel
_PANELS = 4  # in one figure


def pages(
    replays: Sequence[Replay], signals: Sequence[Signal], title: str
) -> Iterator[tuple[int, list[list[Signal]], str]]:
    """Number, panels and title of each figure."""
    panels = [[signal] for signal in signals] if len(replays) > 1 else list(_by_unit(signals))
    pages = [panels[i : i + _PANELS] for i in range(0, len(panels), _PANELS)]
    for number, page in enumerate(pages, start=1):
        yield number, page, title + (f" ({number} of {len(pages)})" if len(pages) > 1 else "")


def _by_unit(signals: Sequence[Signal]) -> Iterator[list[Signal]]:
    groups: dict[tuple[str, tuple[str, ...]], list[Signal]] = {}
    for signal in signals:
        groups.setdefault((signal.unit, signal.levels), []).append(signal)
    for group in groups.values():
        for i in range(0, len(group), _LINES):
            yield group[i : i + _LINES]


def lines_of(replays: Sequence[Replay], group: Sequence[Signal]) -> Iterator[tuple[dict[str, Any], Replay, Signal]]:
    """The lines of a panel. Colours distinguish the signals of one run, or several runs."""
    for r, replay in enumerate(replays):
        for s, signal in enumerate(group):
            if has(replay, signal):
                yield style.look(r if len(replays) > 1 else s), replay, signal


def label_of(replays: Sequence[Replay], replay: Replay, signal: Signal) -> str:
    return replay.label if len(replays) > 1 else signal.address


def name_vertical(axes: Axes, replays: Sequence[Replay], group: Sequence[Signal]) -> None:
    first = group[0]
    names = {signal.address.rpartition(".")[2] for signal in group}
    if len(group) == 1:
        name = first.address
    else:
        name = names.pop().replace("_", " ") if len(names) == 1 else f"{_owner(group)} {style.quantity(first.unit)}"
    axes.set_ylabel("\n".join(_wrapped(name)) + f"\n({style.shown_unit(first.unit)})", fontsize=style.FONT)
    if first.levels:
        axes.set_yticks(range(len(first.levels)), first.levels)
    else:
        style.limit_vertical(axes)
    if len(group) > 1 and len(replays) == 1:
        handles, labels = axes.get_legend_handles_labels()
        short = [label.removeprefix(_owner(group)) for label in labels]
        columns = max(1, min(len(short), 88 // (max(map(len, short)) + 8)))
        style.legend(
            axes,
            handles=handles,
            labels=short,
            loc="lower left",
            bbox_to_anchor=(0, 1),
            ncols=columns,
            frameon=False,
            borderaxespad=0.2,
        )


def _owner(group: Sequence[Signal]) -> str:
    """The part of all signals in a panel, with a dot at its end; empty if they belong to several."""
    owners = {signal.address.rpartition(".")[0] for signal in group}
    return f"{owners.pop()}." if len(owners) == 1 else ""


def _wrapped(name: str) -> list[str]:
    """An address in pieces that fit the height of a panel, divided after dots."""
    lines = [""]
    for piece in re.findall(r"[^. ]+[. ]?", name):
        if lines[-1] and len(lines[-1]) + len(piece) > 24:
            lines.append("")
        lines[-1] += piece
    return lines


def finish(figure: Figure, first: Axes, replays: Sequence[Replay], title: str) -> None:
    """Add a heading that says how runs ended, and one legend for several runs."""
    if len(replays) == 1:
        title = f"{title}, {replays[0].label}"
    endings = [f"{replay.label} {replay.ending}" for replay in replays if replay.ending]
    lines = [title, *(textwrap.shorten(ending, 100) for ending in endings)]
    figure.suptitle("\n".join(textwrap.fill(line, 92) for line in lines), fontsize=style.FONT)
    if len(replays) > 1:
        handles, labels = first.get_legend_handles_labels()
        columns = 1 if max(map(len, labels), default=0) > 36 else 2
        figure.legend(handles, labels, loc="outside lower center", ncols=columns, fontsize=style.FONT - 1)


def caption_of(replays: Sequence[Replay], signals: Sequence[Signal], text: str) -> str:
    sentences = [f"{signal.address} ({style.shown_unit(signal.unit)}): {signal.doc}" for signal in signals]
    sentences += [f"{label} has no such signal." for label in (runs_without(replays, text) if text else ())]
    sentences += [f"{replay.label} {replay.ending}." for replay in replays if replay.ending]
    return " ".join(sentences)


def file_name(text: str, rest: str, number: int) -> str:
    plain = re.sub(r"[^\w.-]+", "_", f"{text.replace('*', 'all')}{rest}")
    return plain if number == 1 else f"{plain}_{number}"
