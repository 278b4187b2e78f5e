"""Texts in the picture: name, time, speed, and the meaning of colours and arrows."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gaitsim.animation import colours
from gaitsim.animation.lettering import Label, write

Pixels = NDArray[np.uint8]


@dataclass(frozen=True)
class Caption:
    """The texts on pictures of one size, in pixels.

    Attributes:
        newtons: The force of an arrow of one metre; None without arrows.
        metre: The length of one metre in pixels.
        ending: How the run was stopped, and the time from which this is shown in s; empty if it was not.
    """

    name: str
    speed: float
    width: int
    height: int
    muscles: bool
    newtons: float | None
    metre: float
    ending: tuple[str, float] = ("", 0.0)

    @property
    def font(self) -> int:
        """The size of letters in pixels."""
        return font_of(self.width, self.height)

    def put_on(self, picture: Pixels, time: float) -> Pixels:
        """Write the texts on a picture, at a time in s."""
        picture, font = np.array(picture), self.font
        edge = 0.7 * font
        labels = [
            Label(self.name, edge, edge, font, "la", bold=True),
            Label(f"t = {time:.3f} s", edge, edge + 1.5 * font, font, "la"),
            Label(speed_words(self.speed), edge, edge + 3.0 * font, font, "la"),
        ]
        ending, begin = self.ending
        if ending and time >= begin:
            labels.append(Label(ending, self.width - edge, edge, font, "ra", bold=True))
        row = self.height - edge - 0.5 * font
        if self.newtons is not None:
            labels.append(self._arrow(picture, row, self.newtons))
            row -= 1.6 * font
        if self.muscles:
            labels += self._bar(picture, row)
        return write(picture, labels)

    def _arrow(self, picture: Pixels, row: float, newtons: float) -> Label:
        """The scale of arrows: the length of a round number of newtons."""
        force = round_below(newtons * 0.2 * self.width / self.metre)
        left, right = round(0.7 * self.font), round(0.7 * self.font + force / newtons * self.metre)
        half, head = max(1, round(0.08 * self.font)), round(0.45 * self.font)
        middle, colour = round(row), [round(255 * part) for part in colours.FORCE]
        picture[middle - half : middle + half + 1, left : right - head] = colour
        for step in range(head + 1):
            reach = round(0.6 * step)
            picture[middle - reach : middle + reach + 1, right - step] = colour
        text = f"{force / 1000:g} kN" if force >= 1000 else f"{force:g} N"
        return Label(f"{text} of ground force", right + 0.5 * self.font, row, self.font, "lm")

    def _bar(self, picture: Pixels, row: float) -> list[Label]:
        """The colours of activation from 0 to 1."""
        left, font = 0.7 * self.font, self.font
        begin, end = round(left + font), round(left + font + 0.2 * self.width)
        half = round(0.35 * font)
        picture[round(row) - half : round(row) + half + 1, begin:end] = colours.scale(end - begin)
        return [
            Label("0", left, row, font, "lm"),
            Label("1  activation", end + 0.3 * font, row, font, "lm"),
        ]


def font_of(width: int, height: int) -> int:
    """The size of letters on a picture of this size, in pixels."""
    return max(10, round(min(width / 30, height / 36)))


def room_for(width: int, height: int, lines_below: int) -> tuple[float, float]:
    """The shares of a picture's height that texts cover: three lines above, and a number of lines below."""
    font = font_of(width, height)
    return 5.2 * font / height, (0.7 + 1.6 * lines_below) * font / height if lines_below else 0.0


def speed_words(speed: float) -> str:
    """The speed of the video, in words."""
    return f"{speed:g} × real time"


def round_below(number: float) -> float:
    """The largest of 1, 2, 5 times a power of ten that does not exceed a number."""
    power = 10.0 ** math.floor(math.log10(number))
    return max(step * power for step in (1, 2, 5) if step * power <= number * (1 + 1e-9))
