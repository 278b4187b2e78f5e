"""Plots of signals beside the picture. matplotlib draws them once, and they are uncovered up to the present time."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from gaitsim.analysis.drawings.style import PALETTE, is_constant, place_exponent, shown_unit, vertical_limits
from gaitsim.animation.lettering import Label, write
from gaitsim.model import Signal
from gaitsim.simulation.outcome import Trajectory

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Pixels = NDArray[np.uint8]
_DPI = 100
_PAGE = 6.0  # s of motion that one page of scopes may show
_POINTS = 4000  # of a line on a page: more than it has pixels
_DECIMALS = 6  # of a number beside a plot; smaller ones have a power of ten
_FAINT = 0.22
_CURSOR = (200, 30, 30)


@dataclass(frozen=True)
class _Page:
    """The plots of a period of time, faint and bright, and the pixel columns of the ends of the axes."""

    begin: float
    end: float
    faint: Pixels
    full: Pixels
    left: float
    right: float
    spans: tuple[tuple[int, int], ...]


@dataclass
class Panel:
    """Plots of signals over a period of time. Sizes are in pixels, times in s."""

    trajectory: Trajectory
    signals: Sequence[Signal]
    width: int
    height: int
    begin: float
    end: float
    _pages: dict[int, _Page] = field(default_factory=dict, repr=False)
    _rows: list[float] = field(default_factory=list, repr=False)

    @property
    def scale(self) -> float:
        """The scale of letters and lines: 1 in a panel of 740 x 720 pixels."""
        return max(0.55, min(self.width / 740, self.height / 720 * 1.2))

    def picture(self, row: int) -> Pixels:
        """The plots at a recorded instant: an array of height x width x 3."""
        time = float(self.trajectory.times[row])
        page = self._page(time)
        share = (time - page.begin) / (page.end - page.begin)
        column = round(page.left + share * (page.right - page.left))
        pixels = page.faint.copy()
        pixels[:, round(page.left) : column] = page.full[:, round(page.left) : column]
        thick = max(1, round(1.5 * self.scale))
        # The line would hide the first letter of the title between two plots.
        for top, bottom in page.spans:
            pixels[top:bottom, column : column + thick] = _CURSOR
        return write(pixels, self._values(row, page))

    def _values(self, row: int, page: _Page) -> list[Label]:
        """The values at this instant, to the right of each plot."""
        size, left = max(9, round(15 * self.scale)), page.right + 10 * self.scale
        labels = []
        for signal, middle in zip(self.signals, self._rows, strict=True):
            text = _value_text(signal, float(self.trajectory[signal.address][row]), self._spans[signal.address])
            labels.append(Label(text, left, middle, size, "lm", bold=True))
        return labels

    def _extremes(self, signal: Signal) -> list[str]:
        """The texts of the smallest and the largest value of a signal."""
        values, span = self._inside(self.trajectory[signal.address]), self._spans[signal.address]
        return [_value_text(signal, float(value), span) for value in (np.min(values), np.max(values))]

    @cached_property
    def _spans(self) -> dict[str, float]:
        """The range of each signal; 0 if it is constant but for rounding error."""
        found = {}
        for signal in self.signals:
            values = self._inside(self.trajectory[signal.address])
            low, high = float(np.min(values)), float(np.max(values))
            found[signal.address] = 0.0 if is_constant(low, high) else high - low
        return found

    def _inside(self, values: NDArray[np.float64]) -> NDArray[np.float64]:
        times = self.trajectory.times
        return values[(times >= self.begin - 1e-9) & (times <= self.end + 1e-9)]

    def _page(self, time: float) -> _Page:
        pages = max(1, math.ceil((self.end - self.begin) / _PAGE - 1e-9))
        length = max(self.end - self.begin, 1e-3) / pages
        number = min(pages - 1, int((time - self.begin) / length))
        if number not in self._pages:
            # Time only advances, so an earlier page is not needed again.
            self._pages = {number: self._draw(self.begin + number * length, self.begin + (number + 1) * length)}
        return self._pages[number]

    def _draw(self, begin: float, end: float) -> _Page:
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure

        figure = Figure(figsize=(self.width / _DPI, self.height / _DPI), dpi=_DPI)
        canvas: Any = FigureCanvasAgg(figure)
        axes = self._axes(figure, begin, end)
        images = []
        for visible in (_FAINT, 1.0):
            for each in axes:
                for artist in (*each.lines, *each.collections):
                    artist.set_alpha(visible if artist in each.lines else 0.35 * visible)
            canvas.draw()
            images.append(np.asarray(canvas.buffer_rgba())[..., :3].copy())
        boxes = [each.get_window_extent() for each in axes]
        self._rows = [self.height - (box.y0 + box.y1) / 2 for box in boxes]
        spans = tuple((round(self.height - box.y1), round(self.height - box.y0)) for box in boxes)
        return _Page(begin, end, images[0], images[1], boxes[0].x0, boxes[0].x1, spans)

    def _axes(self, figure: Figure, begin: float, end: float) -> list[Axes]:
        """One plot below the other, with the name above its left end."""
        font = 9.5 * self.scale
        grid = figure.subplots(len(self.signals), 1, sharex=True, squeeze=False)
        line, em = font * _DPI / 72 / self.height, font * _DPI / 72 / self.width
        # Names of levels are at the left of a plot. They, or else values, are at its right in bold.
        levels = max((len(name) for signal in self.signals for name in signal.levels), default=0)
        letters = max(levels, *(len(text) for signal in self.signals for text in self._extremes(signal)))
        left, right = max(5.2, 0.6 * levels + 1.2) * em, max(8.2, 0.75 * letters + 1.2) * em
        figure.subplots_adjust(
            left=left, right=1 - right, top=1 - 2.2 * line, bottom=4.0 * line, hspace=self._gap(line)
        )
        times = self.trajectory.times
        rows = np.flatnonzero((times >= begin - 1e-9) & (times <= end + 1e-9))
        rows = rows[:: max(1, len(rows) // _POINTS)]
        for i, (each, signal) in enumerate(zip(grid[:, 0], self.signals, strict=True)):
            values = self.trajectory[signal.address]
            self._trace(each, times[rows], values[rows], PALETTE[i % len(PALETTE)], signal)
            each.set_ylim(*_limits(self._inside(values), signal))
            each.set_title(f"{signal.address} ({shown_unit(signal.unit)})", loc="left", fontsize=font, pad=0.3 * font)
            each.tick_params(labelsize=0.9 * font, length=0.25 * font)
            place_exponent(each, 0.9 * font)
            each.spines[["top", "right"]].set_visible(False)
            each.grid(alpha=0.3, linewidth=0.6)
            each.margins(x=0)
        grid[-1, 0].set_xlim(begin, end)
        grid[-1, 0].set_xlabel("time (s)", fontsize=font, labelpad=0.2 * font)
        return list(grid[:, 0])

    def _gap(self, line: float) -> float:
        """The space between two plots for a title, relative to the height of one."""
        count = len(self.signals)
        return (2.3 * line * count) / max(0.05, 1 - 6.2 * line - 2.3 * line * (count - 1))

    def _trace(self, axes: Axes, times: Any, values: Any, colour: str, signal: Signal) -> None:
        if _is_phase(self.trajectory[signal.address], signal):
            axes.fill_between(times, 0, values, step="post", color=colour, linewidth=0)
            axes.plot(times, values, drawstyle="steps-post", color=colour, linewidth=1.2 * self.scale)
            names = signal.levels or ("0", "1")
            axes.set_yticks(range(len(names)), names)
        else:
            axes.plot(times, values, color=colour, linewidth=1.6 * self.scale)
            axes.locator_params(axis="y", nbins=3)


def _is_phase(values: NDArray[np.float64], signal: Signal) -> bool:
    """Whether a signal has a few values only: a state with levels, or 0 and 1."""
    return bool(signal.levels) or (signal.unit == "1" and bool(np.all((values == 0) | (values == 1))))


def _limits(values: NDArray[np.float64], signal: Signal) -> tuple[float, float]:
    if signal.levels:
        return -0.1, len(signal.levels) - 0.8
    low, high = float(np.nanmin(values)), float(np.nanmax(values))
    return vertical_limits(low, high, 0.06)


def _value_text(signal: Signal, value: float, span: float) -> str:
    """A number with its unit and as many decimals as its plot resolves; or the name of a level."""
    if signal.levels:
        return signal.levels[int(value)]
    decimals = max(0, 2 - math.floor(math.log10(span))) if span > 0 else 3
    text = f"{value:.2e}" if decimals > _DECIMALS else f"{round(value, decimals) + 0.0:.{decimals}f}"  # 0 has no sign
    text = text.replace("-", "\N{MINUS SIGN}")
    return text if signal.unit == "1" else f"{text} {shown_unit(signal.unit)}"
