"""Videos of a recorded run: the moving body, and plots of signals."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from gaitsim.analysis.replays.replay import Replay
from gaitsim.animation import colours, scopes
from gaitsim.animation.camera import VIEWS, Views, follow
from gaitsim.animation.canvas import Canvas
from gaitsim.animation.caption import Caption, room_for
from gaitsim.animation.encoder import Encoder
from gaitsim.animation.errors import CannotAnimate
from gaitsim.animation.panel import Panel
from gaitsim.animation.posture import Posture, rows_at
from gaitsim.animation.stage import stage_of
from gaitsim.errors import Usage

Pixels = NDArray[np.uint8]
Progress = Callable[[int, int], None]
ENDINGS = (".mp4", ".gif")
_SHARE = 0.42  # of the width for the picture; of the height, if the video is upright, 0.5
_SCOPE = 45  # pixels: the least height of one
_SAMPLES = 6  # number of frames from which the colours of a GIF are taken
_SWATCH = 100  # rows of pixels


@dataclass(frozen=True)
class VideoOptions:
    """The options of a video.

    Attributes:
        speed: Seconds of motion per second of video.
        rate: Frames per second; rounded for a GIF to what GIFs support.
        size: Width and height in pixels; odd numbers are made even.
        scopes: Addresses or patterns of signals; empty for the default ones.
        begin, end: The part of the motion, in s.
        view: The direction of the view, a name in `VIEWS`.
    """

    speed: float = 1.0
    rate: float | None = None
    size: tuple[int, int] | None = None
    scopes: Sequence[str] = ()
    begin: float | None = None
    end: float | None = None
    view: str = "side"


def record(replay: Replay, path: Path, options: VideoOptions | None = None, progress: Progress | None = None) -> Path:
    """Write the video of a run.

    Args:
        replay: The run.
        path: The file; its ending chooses MP4 or GIF.
        options: The options.
        progress: Receives the number of frames that are done, and of all frames.

    Raises:
        NoOpenGL: OpenGL does not work here.
        CannotAnimate: The model cannot be drawn.
        NoSuchSignal: No run has such a signal.
        Usage: The request does not fit.
    """
    film = _Film(replay, path, options or VideoOptions())
    with ExitStack() as stack:
        canvas = stack.enter_context(film.canvas)
        sample = film.sample(canvas) if film.is_gif else None
        encoder = stack.enter_context(Encoder(path, film.rate, film.size, sample))
        for k in range(len(film.rows)):
            encoder.add(film.frame(canvas, k))
            if progress is not None:
                progress(k + 1, len(film.rows))
    return path


class _Film:
    """What all frames of one video share."""

    def __init__(self, replay: Replay, path: Path, options: VideoOptions) -> None:
        self.is_gif = path.suffix.lower() == ".gif"
        self.rate = _rate(options, self.is_gif)
        self.size = _size(options, self.is_gif)
        _check(path, options, self.rate, self.size)
        times = _times(replay, options, self.rate)
        stage = stage_of(replay.model, wide=options.view != "side")
        self.posture = Posture(stage, replay.trajectory)
        self.rows = rows_at(replay.trajectory, times)
        self.beside = self.size[0] >= self.size[1]
        width, height = self.picture_size
        rest = (self.size[0] - width, self.size[1]) if self.beside else (self.size[0], self.size[1] - height)
        room = max(1, rest[1] // _SCOPE)
        signals = scopes.chosen(replay.model, options.scopes) or scopes.usual(replay.model, stage)[:room]
        _check_room(len(signals), room)
        self.panel = Panel(replay.trajectory, signals, *rest, float(times[0]), float(times[-1]))
        covered = room_for(width, height, bool(stage.forces) + bool(stage.muscles))
        self.views: Views = follow(
            self.posture, self.rows, options.speed / self.rate, width / height, covered, options.view
        )
        newtons = self.views.newtons if stage.forces else None
        metre = self.views.pixels_of_a_metre(height)
        ending = _ending(replay, options.speed)
        self.caption = Caption(replay.name, options.speed, width, height, bool(stage.muscles), newtons, metre, ending)
        self.canvas = Canvas(self.posture, width, height)

    @property
    def picture_size(self) -> tuple[int, int]:
        """The size of the picture of the body in a frame."""
        width, height = self.size
        return (2 * round(_SHARE * width / 2), height) if self.beside else (width, 2 * round(height / 4))

    def frame(self, canvas: Canvas, number: int) -> Pixels:
        """One whole frame: an array of height x width x 3."""
        row = int(self.rows[number])
        self.posture.take(row)
        picture = self.caption.put_on(canvas.picture(self.views, number), float(self.panel.trajectory.times[row]))
        return np.concatenate([picture, self.panel.picture(row)], axis=1 if self.beside else 0)

    def sample(self, canvas: Canvas) -> Pixels:
        """Frames from the whole video, and all colours of activation, for the palette of a GIF."""
        chosen = sorted({round(k) for k in np.linspace(0, len(self.rows) - 1, _SAMPLES)})
        swatch = np.tile(colours.scale(self.size[0]), (_SWATCH, 1, 1))
        return np.concatenate([*(self.frame(canvas, k) for k in chosen), swatch])


def _ending(replay: Replay, speed: float) -> tuple[str, float]:
    """The text at the end of the video about the measure that stopped the run, and the time from which it is shown."""
    if not (replay.outcome.level and replay.reaches_end):
        return "", 0.0
    return replay.outcome.level.replace("_", " "), float(replay.times[-1]) - speed


def read_size(text: str) -> tuple[int, int]:
    """Read width and height from a text such as 1280x720.

    Raises:
        Usage: The request does not fit.
    """
    width, _, height = text.lower().partition("x")
    if not (width.isdecimal() and height.isdecimal()):
        raise Usage(f"--size {text}: width x height in pixels, such as 1280x720.")
    return int(width), int(height)


def _rate(options: VideoOptions, is_gif: bool) -> float:
    """Frames per second. A GIF shows each frame for a whole number of hundredths of a second, at least 2."""
    rate = options.rate if options.rate is not None else (20.0 if is_gif else 30.0)
    return 100.0 / max(2, round(100.0 / rate)) if is_gif and rate > 0 else rate


def _size(options: VideoOptions, is_gif: bool) -> tuple[int, int]:
    width, height = options.size or ((800, 450) if is_gif else (1280, 720))
    return 2 * (width // 2), 2 * (height // 2)


def _check(path: Path, options: VideoOptions, rate: float, size: tuple[int, int]) -> None:
    if path.suffix.lower() not in ENDINGS:
        raise Usage(f"{path}: a video ends in {' or '.join(ENDINGS)}.")
    if not options.speed > 0:
        raise Usage(f"--speed {options.speed:g}: seconds of motion in a second of video, above 0, such as 0.25.")
    if options.view not in VIEWS:
        raise Usage(f"--view {options.view}: one of {', '.join(VIEWS)}.")
    if not 1 <= rate <= 240:
        raise Usage(f"--fps {rate:g}: frames in a second, from 1 to 240.")
    if min(size) < 200 or max(size) > 4096:
        raise Usage(f"--size {size[0]}x{size[1]}: width x height in pixels, each from 200 to 4096.")


def _check_room(wanted: int, room: int) -> None:
    if wanted > room:
        raise Usage(f"--scopes: {wanted} signals match, and this size has room for {room}; narrow it.")


def _times(replay: Replay, options: VideoOptions, rate: float) -> NDArray[np.float64]:
    """The time of each frame."""
    known = replay.trajectory.times
    if len(known) == 0:
        raise CannotAnimate(f"{replay.label}: no motion was recorded, so there is no video ({replay.ending}).")
    first, last = float(known[0]), float(known[-1])
    begin = first if options.begin is None else max(first, options.begin)
    end = last if options.end is None else min(last, options.end)
    if begin > end:
        raise Usage(f"there is no motion from {begin:g} s to {end:g} s; it goes from {first:g} s to {last:g} s.")
    frames = int((end - begin) * rate / options.speed + 1e-6) + 1
    return begin + np.arange(frames, dtype=np.float64) * (options.speed / rate)
