"""report.html: one self-contained page with numbers, figures, video, origin, and the model."""

from __future__ import annotations

import base64
import io
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from gaitsim.analysis.drawings.drawing import Drawing
from gaitsim.analysis.drawings.style import COLUMN
from gaitsim.analysis.gait.changes import changes_table
from gaitsim.analysis.gait.numbers import gait_table, norms_table
from gaitsim.analysis.replays.replay import Replay
from gaitsim.analysis.report import facts
from gaitsim.analysis.report.figures import missing
from gaitsim.whole import write_whole

if TYPE_CHECKING:
    from jinja2 import Template

EMBEDDED = 8_000_000  # bytes; a larger video is linked
_NARROW = 3.9  # inches: a figure on a telephone
_LARGEST_SVG = 400_000  # bytes; beyond, the picture is made of pixels
_TYPES = {".mp4": "video/mp4", ".webm": "video/webm", ".gif": "image/gif"}


@dataclass(frozen=True)
class Film:
    """A video on the page.

    Attributes:
        address: Its address.
        name: Its file name.
        embedded: Whether it is within the page, and not a file beside it.
        moving_picture: Whether it is a GIF.
    """

    address: str
    name: str
    embedded: bool
    moving_picture: bool


@dataclass(frozen=True)
class Picture:
    """A figure on the page, in two widths."""

    name: str
    title: str
    caption: str
    wide: str
    narrow: str


def write(
    path: Path,
    replays: Sequence[Replay],
    drawings: Sequence[Drawing],
    video: Path | None = None,
    remarks: Sequence[str] = (),
) -> Path:
    """Write the report of one run, or of several runs beside each other.

    Args:
        path: The file.
        replays: The runs.
        drawings: The figures.
        video: The video, if there is one.
        remarks: Remarks for the reader, such as what could not be made.

    Returns:
        The path.

    Raises:
        OSError: The file cannot be read or written.
    """
    page = _template().render(
        title=" and ".join(dict.fromkeys(replay.name for replay in replays)),
        runs=[_run(replay) for replay in replays],
        metrics=facts.metrics_table(replays),
        changes=changes_table(replays),
        remarks=list(dict.fromkeys([*_remarks(replays), *remarks])),
        pictures=[_picture(drawing) for drawing in drawings],
        film=None if video is None else _film(video, path.parent),
    )
    path.parent.mkdir(parents=True, exist_ok=True)
    write_whole(path, page)
    return path


def _remarks(replays: Sequence[Replay]) -> list[str]:
    return [remark for replay in replays for remark in (*replay.notices, *missing(replay))]


@cache
def _template() -> Template:
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    folder = Path(__file__).parent / "page"
    loader = FileSystemLoader(folder)
    made = Environment(loader=loader, autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True)
    return made.get_template("report.html")


def _run(replay: Replay) -> Mapping[str, Any]:
    outcome = replay.outcome
    return {
        "label": replay.label,
        "status": outcome.status,
        "ending": replay.ending or f"ran its whole time of {outcome.simulated_seconds:g} s",
        "about": _about(replay),
        "gait": gait_table(replay),
        "norms": norms_table(replay),
        "study": facts.study_table(replay),
        "tuned": facts.tuned_table(replay),
        "origin": facts.origin(replay),
        "components": facts.components_table(replay.model),
        "references": facts.references(replay),
        "tree": facts.tree(replay.model),
    }


def _about(replay: Replay) -> str:
    """The description in the spec; empty without one, or if it cannot be read."""
    from gaitsim.errors import GaitsimError
    from gaitsim.spec.resolve import read_spec
    from gaitsim.text.document import ScalarNode

    try:
        about = read_spec(replay.folder / "spec.yaml" if replay.folder else replay.path).entries.get("about")
    except (GaitsimError, OSError):
        return ""
    return str(about.value) if isinstance(about, ScalarNode) else ""


def _picture(drawing: Drawing) -> Picture:
    return Picture(drawing.name, drawing.title, drawing.caption, _image(drawing), _image(drawing, _NARROW))


def _image(drawing: Drawing, width: float = COLUMN) -> str:
    """The figure at a width in inches, as a data URL. The same figure gives the same bytes."""
    import matplotlib as mpl

    figure = drawing.figure
    size = tuple(figure.get_size_inches())
    with mpl.rc_context({"svg.hashsalt": drawing.name, "svg.fonttype": "path"}):
        try:
            figure.set_size_inches(width, size[1] * _taller(width, size[0]))
            text = io.BytesIO()
            figure.savefig(text, format="svg", metadata={"Date": None})
            if text.tell() <= _LARGEST_SVG:
                return _address("image/svg+xml", text.getvalue())
            pixels = io.BytesIO()
            figure.savefig(pixels, format="png", dpi=200)
            return _address("image/png", pixels.getvalue())
        finally:
            figure.set_size_inches(*size)


def _taller(width: float, own: float) -> float:
    """The height of a narrow figure: half of what it loses in width is kept in height."""
    return 0.5 + 0.5 * min(1.0, width / own)


def _film(video: Path, folder: Path) -> Film:
    moving = video.suffix == ".gif"
    if video.stat().st_size <= EMBEDDED:
        return Film(_address(_TYPES[video.suffix], video.read_bytes()), video.name, True, moving)
    beside = video.relative_to(folder).as_posix() if video.is_relative_to(folder) else video.resolve().as_uri()
    return Film(beside, video.name, False, moving)


def _address(kind: str, content: bytes) -> str:
    return f"data:{kind};base64,{base64.b64encode(content).decode('ascii')}"
