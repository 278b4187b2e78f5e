"""A picture with its words: figure, file name, title, caption."""

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
        name: Of its file, without ending.
        caption: What is seen, with its units, as one paragraph.
    """

    name: str
    title: str
    caption: str
    figure: Figure = field(repr=False)


# Gives the figures that a run's parts allow; none if it is not about such a model.
Figures = Callable[["Replay"], list[Drawing]]


def save(drawings: Iterable[Drawing], folder: Path, formats: Sequence[str] = ("png",)) -> list[Path]:
    """Write each drawing as files of the formats (png, svg, pdf); their paths.

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
