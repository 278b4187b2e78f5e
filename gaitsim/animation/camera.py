"""The camera follows the motion without its bounces."""

from __future__ import annotations

import math
from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from gaitsim.animation.posture import Floats, Posture

VIEWS = {"side": (90.0, -6.0), "behind": (0.0, -8.0), "oblique": (50.0, -12.0)}  # degrees: azimuth and elevation
FIELD = 20.0  # degrees of view from top to bottom: narrow, so that lengths are nearly to scale
_SMOOTHING = 0.5  # s, standard deviation: several hops or steps become a line
_STILL = 1.6
_PLANAR = 1e-6  # m
_ABOVE, _BELOW, _BESIDE = 0.14, 0.06, 0.05  # of the picture, kept free; there are words above
_ROOM = 0.3  # of the body's height: the longest force arrow


@dataclass(frozen=True)
class Views:
    """The point in the center of each frame (frames x 3, in m), and the distance of the camera (in m).

    Attributes:
        newtons: The force of an arrow of one metre.
        view: A name in `VIEWS`.
    """

    points: Floats
    distance: float
    newtons: float
    view: str = "side"

    @property
    def away(self) -> Floats:
        """The horizontal direction away from the camera."""
        return _axes(self.view)[1]

    @property
    def half_height(self) -> float:
        """Half the height of what is visible at the body, in m."""
        return self.distance * math.tan(math.radians(FIELD / 2))

    def pixels_of_a_metre(self, height: int) -> float:
        """The pixels of one metre at the body, in a picture of this height in pixels."""
        return height / (2 * self.half_height)

    def camera(self, frame: int) -> mujoco.MjvCamera:
        """The camera of a frame: at the right side, so that forwards is to the right, or behind, or between the two."""
        camera = mujoco.MjvCamera()
        camera.azimuth, camera.elevation = VIEWS[self.view]
        camera.distance = self.distance
        camera.lookat[:] = self.points[frame]
        return camera


def follow(
    posture: Posture,
    rows: NDArray[np.int64],
    spacing: float,
    aspect: float,
    covered: tuple[float, float] = (0, 0),
    view: str = "side",
) -> Views:
    """The views of some instants.

    Args:
        posture: The recorded motion.
        rows: The instants.
        spacing: The time between them, in s.
        aspect: Width over height of the picture.
        covered: The shares of the height that texts cover, above and below; the body stays between them.
        view: A name in `VIEWS`.
    """
    right, away = _axes(view)
    above, below = max(_ABOVE, covered[0]), max(_BELOW, covered[1])
    centers, lows, highs = np.zeros((len(rows), 3)), np.zeros((len(rows), 3)), np.zeros((len(rows), 3))
    for k, row in enumerate(rows):
        posture.take(int(row))
        centers[k] = posture.center_of_mass
        lows[k], highs[k] = posture.extent
    centers, lows, highs = _turned(centers, lows, highs, right, away)
    newtons = _scale(posture, rows, float(np.max(highs[:, 2] - lows[:, 2])))
    if posture.stage.forces:
        lows[:, 2] = np.minimum(lows[:, 2], 0)
    points, half = _centered(_smooth(centers, spacing), lows, highs)
    still, still_half = _centered(np.zeros_like(centers), lows, highs)
    for axis in (0, 2):
        # A fixed camera is better, as long as the body keeps about the same size in the picture.
        if still_half[axis] < _STILL * half[axis]:
            points[:, axis], half[axis] = still[:, axis], still_half[axis]
    # Planar motion stays in its plane.
    points[:, 1] = _smooth(centers, spacing)[:, 1] if np.ptp(centers[:, 1]) > _PLANAR else 0
    high = max(half[2] / (1 - above - below), half[0] / aspect / (1 - 2 * _BESIDE), 0.05)
    points[:, 2] += (above - below) * high
    world = points[:, :1] * right + points[:, 1:2] * away + points[:, 2:] * np.array([0.0, 0.0, 1.0])
    return Views(world, high / math.tan(math.radians(FIELD / 2)), newtons, view)


def _axes(view: str) -> tuple[Floats, Floats]:
    """The horizontal directions to the right in a picture, and away from the camera."""
    azimuth = math.radians(VIEWS[view][0])
    sine, cosine = round(math.sin(azimuth), 12), round(math.cos(azimuth), 12)
    return np.array([sine, -cosine, 0.0]), np.array([cosine, sine, 0.0])


def _turned(centers: Floats, lows: Floats, highs: Floats, right: Floats, away: Floats) -> tuple[Floats, Floats, Floats]:
    """Centers and corners of boxes along the axes of a picture: right, away, up."""
    found = [centers.copy(), lows.copy(), highs.copy()]
    for i, axis in enumerate((right, away)):
        found[0][:, i] = centers @ axis
        found[1][:, i] = np.minimum(lows * axis, highs * axis).sum(axis=1)
        found[2][:, i] = np.maximum(lows * axis, highs * axis).sum(axis=1)
    return found[0], found[1], found[2]


def _centered(path: Floats, lows: Floats, highs: Floats) -> tuple[Floats, Floats]:
    """A path that is moved so that the visible range extends equally to both sides, and that range."""
    above, below = np.max(highs - path, axis=0), np.max(path - lows, axis=0)
    return path + (above - below) / 2, (above + below) / 2


def _scale(posture: Posture, rows: NDArray[np.int64], height: float) -> float:
    """The newtons of one metre of arrow: 1, 2 or 5 times a power of ten, so that the longest arrow fits."""
    columns = [
        posture.trajectory.signals.index(signal)
        for force in posture.stage.forces
        for signal in (force.up, force.forward, force.left)
        if signal is not None
    ]
    values = posture.trajectory.values[rows][:, columns]
    largest = float(np.max(np.abs(values), initial=0.0))
    if largest <= 0:
        return 1000.0
    least = largest / max(_ROOM * height, 0.01)
    power = 10.0 ** math.floor(math.log10(least))
    return next(step * power for step in (1, 2, 5, 10) if step * power >= least)


def _smooth(path: Floats, spacing: float) -> Floats:
    """A moving average with Gaussian weights. Beyond its ends the path is extrapolated."""
    reach = min(len(path) - 1, math.ceil(3 * _SMOOTHING / spacing))
    if reach < 1:
        return path.copy()
    weights = np.exp(-0.5 * (np.arange(-reach, reach + 1) * spacing / _SMOOTHING) ** 2)
    before = 2 * path[0] - path[reach:0:-1]
    after = 2 * path[-1] - path[-2 : -reach - 2 : -1]
    longer = np.concatenate([before, path, after])
    columns = [np.convolve(longer[:, axis], weights / weights.sum(), mode="valid") for axis in range(3)]
    return np.stack(columns, axis=1)
