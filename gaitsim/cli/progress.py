"""One line of progress: rewritten on a terminal, a new line every few seconds elsewhere."""

from __future__ import annotations

import sys
import time
from typing import TYPE_CHECKING

from gaitsim.cli import console

if TYPE_CHECKING:
    from gaitsim.optimization.search import Progress

_EVERY = 0.2  # seconds between updates on a terminal


class ProgressLine:
    """The state of a search, its speed, and the longest remaining time."""

    def __init__(self, generations: int) -> None:
        self._generations = generations
        self._terminal = sys.stderr.isatty()
        self._began = self._reported = time.monotonic()
        self._line = ""

    def update(self, progress: Progress) -> None:
        now = time.monotonic()
        last = progress.generation == self._generations
        if now - self._reported < (_EVERY if self._terminal else console.PLAIN_EVERY) and not last:
            return
        text = self._text(progress, now - self._began)
        if text == self._line:
            return
        self._reported, self._line = now, text
        if self._terminal:
            console.rewrite(text)
        else:
            console.say(text)

    def close(self) -> None:
        if self._terminal and self._line:
            console.say("")

    def _text(self, progress: Progress, seconds: float) -> str:
        rate = progress.evaluated_now / seconds if seconds > 0 else 0.0
        population = progress.asked or len(progress.last)
        missing = (self._generations - progress.generation) * population - progress.arrived
        left = _clock(missing / rate) if rate else "-"
        score = progress.best.verdict.score if progress.best else None
        return (
            f"generation {progress.generation}/{self._generations}  best {console.formatted(score)}  "
            f"{progress.evaluations + progress.arrived} evaluations, {progress.failed} failed, {rate:.1f}/s, "
            f"{left} left at most"
        )


def _clock(seconds: float) -> str:
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02}:{rest:02}" if hours else f"{minutes}:{rest:02}"
