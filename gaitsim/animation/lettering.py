"""Text on pictures."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

Pixels = NDArray[np.uint8]
INK = (30, 34, 40)


@dataclass(frozen=True)
class Label:
    """A line of text. Its `anchor` is at a position in pixels from the left and the top; its size is in pixels.

    Attributes:
        anchor: l, m or r (left, middle, right), followed by a, m or s (top, middle, baseline).
    """

    text: str
    left: float
    top: float
    size: int
    anchor: Literal["la", "lm", "ls", "ma", "mm", "ra", "rm", "rs"] = "la"
    bold: bool = False
    colour: tuple[int, int, int] = INK


def write(pixels: Pixels, labels: Sequence[Label]) -> Pixels:
    """Draw lines of text on a picture.

    Args:
        pixels: Height x width x 3 values.
        labels: The lines of text.

    Returns:
        A copy of the picture with the text on it.
    """
    from PIL import Image, ImageDraw

    image = Image.fromarray(np.ascontiguousarray(pixels))
    draw = ImageDraw.Draw(image)
    for each in labels:
        font = _font(each.size, each.bold)
        draw.text((each.left, each.top), each.text, each.colour, font, anchor=each.anchor)
    return np.asarray(image)


@cache
def _font(size: int, bold: bool) -> Any:
    import matplotlib
    from PIL import ImageFont

    name = "DejaVuSans-Bold.ttf" if bold else "DejaVuSans.ttf"
    return ImageFont.truetype(str(Path(matplotlib.get_data_path()) / "fonts" / "ttf" / name), size)
