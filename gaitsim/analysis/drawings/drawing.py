"""A figure with its file name, title and caption."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from gaitsim.whole import whole

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from gaitsim.analysis.replays.replay import Replay


@dataclass(frozen=True)
class Drawing:
    """One figure.

    Attributes:
        name: The name of its file, without ending.
        title: Its title.
        caption: What it shows, with units, as one paragraph.
        figure: The figure of matplotlib.
    """

    name: str
    title: str
    caption: str
    figure: Figure = field(repr=False)


# Makes the figures of a run; none for a model that they do not apply to.
Figures = Callable[["Replay"], list[Drawing]]


def save(drawings: Iterable[Drawing], folder: Path, formats: Sequence[str] = ("png",)) -> list[Path]:
    """Write drawings to files.

    Args:
        drawings: The drawings.
        folder: The folder of the files.
        formats: png, svg, pdf.

    Returns:
        The paths of the files.

    Raises:
        OSError: The file cannot be read or written.
    """
    folder.mkdir(parents=True, exist_ok=True)
    paths = []
    for drawing in drawings:
        for ending in formats:
            path = folder / f"{drawing.name}.{ending}"
            with whole(path) as draft:
                drawing.figure.savefig(draft, format=ending)
            paths.append(path)
    return paths
