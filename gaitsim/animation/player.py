"""The time of a motion that is played in a loop, with pause, single steps and speed."""

from __future__ import annotations

from dataclasses import dataclass

# Codes of keys as GLFW counts them.
SPACE, RIGHT, LEFT, DOWN, UP, HOME = 32, 262, 263, 264, 265, 268
_FRAME = 1 / 60  # s of a viewer's time: one step
_SLOWEST, _FASTEST = 1 / 256, 16.0


@dataclass
class Player:
    """The position in a motion from `begin` to `end`. Times are in s of motion, the speed in s of motion per s."""

    begin: float
    end: float
    speed: float = 1.0
    paused: bool = False
    time: float = 0.0

    def __post_init__(self) -> None:
        self.time = self.begin

    def advance(self, seconds: float) -> None:
        """Advance by a time of the viewer in s."""
        if not self.paused:
            self._move(seconds * self.speed)

    def press(self, key: int) -> None:
        """Handle a key: space pauses, left and right step, up and down double and halve the speed, home restarts."""
        if key == SPACE:
            self.paused = not self.paused
        elif key in (LEFT, RIGHT):
            self.paused = True
            self._move((1 if key == RIGHT else -1) * _FRAME * self.speed)
        elif key in (UP, DOWN):
            self.speed = min(_FASTEST, max(_SLOWEST, self.speed * (2 if key == UP else 0.5)))
        elif key == HOME:
            self.time = self.begin

    def _move(self, seconds: float) -> None:
        length = self.end - self.begin
        self.time = self.begin if length <= 0 else self.begin + (self.time + seconds - self.begin) % length
