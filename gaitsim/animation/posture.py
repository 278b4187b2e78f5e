"""The posture at each recorded instant. Signals are written into MuJoCo's coordinates; nothing is simulated."""

from __future__ import annotations

from collections.abc import Sequence

import mujoco
import numpy as np
from numpy.typing import NDArray

from gaitsim.animation.errors import CannotAnimate
from gaitsim.animation.stage import Force, Spot, Stage
from gaitsim.simulation.outcome import Trajectory

Floats = NDArray[np.float64]


class Posture:
    """MuJoCo's data of a stage at a recorded instant."""

    def __init__(self, stage: Stage, trajectory: Trajectory) -> None:
        """Tie every joint coordinate to a recorded signal.

        Raises:
            CannotAnimate: Nothing was recorded.
        """
        if len(trajectory.times) == 0:
            raise CannotAnimate("no motion was recorded, so there is nothing to show; see why the run failed.")
        self.stage, self.trajectory = stage, trajectory
        self.data = mujoco.MjData(stage.mechanics)
        self.row = 0
        self._column = {signal: i for i, signal in enumerate(trajectory.signals)}
        self._places = np.array([place for place, _ in stage.coordinates], dtype=np.int64)
        self._columns = np.array([self._column[signal] for _, signal in stage.coordinates], dtype=np.int64)
        self.take(0)

    def take(self, row: int) -> None:
        """Set the posture of a recorded instant."""
        self.row = row
        self.data.qpos[self._places] = self.trajectory.values[row, self._columns]
        self.data.time = self.trajectory.times[row]
        mujoco.mj_kinematics(self.stage.mechanics, self.data)
        mujoco.mj_comPos(self.stage.mechanics, self.data)
        mujoco.mj_camlight(self.stage.mechanics, self.data)
        mujoco.mj_tendon(self.stage.mechanics, self.data)

    def signal(self, address: str | None) -> float:
        """The value of a signal at this instant; 0 for none."""
        return 0.0 if address is None else float(self.trajectory.values[self.row, self._column[address]])

    def place(self, spot: Spot) -> Floats:
        """The position of a spot in the world, in m."""
        turn = self.data.xmat[spot.body].reshape(3, 3)
        found = self.data.xpos[spot.body] + turn @ np.array(spot.position)
        for axis, way in ((0, spot.forward), (2, spot.up)):
            if way is not None:
                found[axis] += way[1] * self.signal(way[0])
        return np.asarray(found)

    def force(self, force: Force) -> Floats:
        """A force in the world, in N."""
        forward, left, up = (np.array(axis) for axis in force.axes)
        found = self.signal(force.forward) * forward + self.signal(force.up) * up
        return np.asarray(found + self.signal(force.left) * left)

    @property
    def center_of_mass(self) -> Floats:
        """The center of mass of the model, in m."""
        return np.array(self.data.subtree_com[0])

    @property
    def extent(self) -> tuple[Floats, Floats]:
        """The lowest and the highest corner of everything visible except the ground, in m."""
        mechanics = self.stage.mechanics
        seen = np.flatnonzero((mechanics.geom_bodyid > 0) & (mechanics.geom_rgba[:, 3] > 0))
        low, high = [], []
        for geom in seen:
            middle, half = mechanics.geom_aabb[geom, :3], mechanics.geom_aabb[geom, 3:]
            turn = self.data.geom_xmat[geom].reshape(3, 3)
            center, reach = self.data.geom_xpos[geom] + turn @ middle, np.abs(turn) @ half
            low.append(center - reach)
            high.append(center + reach)
        for line in self.stage.lines:
            places = [self.place(spot) for spot in line.spots]
            low += [place - line.radius for place in places]
            high += [place + line.radius for place in places]
        if not low:
            return self.center_of_mass, self.center_of_mass
        return np.min(low, axis=0), np.max(high, axis=0)


def rows_at(trajectory: Trajectory, times: Sequence[float] | Floats) -> NDArray[np.int64]:
    """The recorded instants nearest to the given times."""
    known = trajectory.times
    after = np.clip(np.searchsorted(known, times), 1, max(1, len(known) - 1))
    if len(known) == 1:
        return np.zeros(len(times), dtype=np.int64)
    nearer = np.asarray(times) - known[after - 1] < known[after] - np.asarray(times)
    return np.where(nearer, after - 1, after).astype(np.int64)
