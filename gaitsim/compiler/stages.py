"""Stages of MuJoCo's step that gaitsim makes itself, as functions on arrays of numbers.

MuJoCo's own are general: they merge whole chains of joints for each piece of a path and each direction of a contact.
Here, the joints between the two ends of a piece are known beforehand, and a contact without force costs nothing. Python
runs these functions as they are, native code compiles them. `compiler/chains.py` makes the tables: `hinges` and `links`
have coordinates of one body that turn about one point, or that slide.
"""

from __future__ import annotations

import math
from typing import Any


def look_at_paths(
    counts: Any,
    paths: Any,
    pieces: Any,
    hinges: Any,
    freedoms: Any,
    fixed_lengths: Any,
    pulls: Any,
    qvel: Any,
    site_xpos: Any,
    xaxis: Any,
    xanchor: Any,
    arms: Any,
    ten_length: Any,
    ten_velocity: Any,
    actuator_length: Any,
    actuator_velocity: Any,
) -> None:
    """Lengths and velocities of paths, and their rates of length per coordinate."""
    for path in range(counts[0]):
        ten_length[path] = fixed_lengths[path]
        for k in range(paths[2 * path], paths[2 * path + 1]):
            arms[k] = 0.0
    for piece in range(counts[1]):
        path, a, b = pieces[5 * piece], 3 * pieces[5 * piece + 1], 3 * pieces[5 * piece + 2]
        x, y, z = site_xpos[b] - site_xpos[a], site_xpos[b + 1] - site_xpos[a + 1], site_xpos[b + 2] - site_xpos[a + 2]
        distance = math.sqrt(x * x + y * y + z * z)
        ten_length[path] += distance
        if distance > 0.0:
            x, y, z = x / distance, y / distance, z / distance
        for k in range(pieces[5 * piece + 3], pieces[5 * piece + 4]):
            first, last, moved = hinges[6 * k], hinges[6 * k + 1], 3 * hinges[6 * k + 3]
            place, sign = hinges[6 * k + 4] - first, hinges[6 * k + 5]
            mx, my, mz = sign * x, sign * y, sign * z
            if hinges[6 * k + 2] > 0:
                rx = sign * (site_xpos[moved] - xanchor[3 * first])
                ry = sign * (site_xpos[moved + 1] - xanchor[3 * first + 1])
                rz = sign * (site_xpos[moved + 2] - xanchor[3 * first + 2])
                mx, my, mz = ry * z - rz * y, rz * x - rx * z, rx * y - ry * x
            for i in range(first, last):
                arms[place + i] += xaxis[3 * i] * mx + xaxis[3 * i + 1] * my + xaxis[3 * i + 2] * mz
    for path in range(counts[0]):
        velocity = 0.0
        for k in range(paths[2 * path], paths[2 * path + 1]):
            velocity += arms[k] * qvel[freedoms[k]]
        ten_velocity[path] = velocity
    for pull in range(counts[2]):
        actuator, path = pulls[2 * pull], pulls[2 * pull + 1]
        actuator_length[actuator], actuator_velocity[actuator] = ten_length[path], ten_velocity[path]


def look_at_contacts(
    counts: Any,
    motors: Any,
    spheres: Any,
    pushes: Any,
    wrenches: Any,
    qpos: Any,
    qvel: Any,
    site_xpos: Any,
    cvel: Any,
    subtree_com: Any,
    actuator_length: Any,
    actuator_velocity: Any,
) -> None:
    """Coordinates and velocities of pushes, and of motors at joints."""
    for motor in range(counts[3]):
        actuator, i = motors[2 * motor], motors[2 * motor + 1]
        actuator_length[actuator], actuator_velocity[actuator] = qpos[i], qvel[i]
    for sphere in range(counts[4]):
        site, body, root = 3 * spheres[7 * sphere], 6 * spheres[7 * sphere + 1], 3 * spheres[7 * sphere + 2]
        px, py, pz = site_xpos[site], site_xpos[site + 1], site_xpos[site + 2]
        rx, ry, rz = px - subtree_com[root], py - subtree_com[root + 1], pz - subtree_com[root + 2]
        wx, wy, wz = cvel[body], cvel[body + 1], cvel[body + 2]
        vx, vy = cvel[body + 3] + wy * rz - wz * ry, cvel[body + 4] + wz * rx - wx * rz
        vz = cvel[body + 5] + wx * ry - wy * rx
        for k in range(spheres[7 * sphere + 3], spheres[7 * sphere + 4]):
            w, actuator = 7 * k, pushes[k]
            along = wrenches[w] * px + wrenches[w + 1] * py + wrenches[w + 2] * pz
            linear = wrenches[w] * vx + wrenches[w + 1] * vy + wrenches[w + 2] * vz
            angular = wrenches[w + 3] * wx + wrenches[w + 4] * wy + wrenches[w + 5] * wz
            actuator_length[actuator] = along - wrenches[w + 6]
            actuator_velocity[actuator] = linear + angular


def force(gains: Any, actuator: int, control: float, velocity: float) -> float:
    """The force of an actuator, within its limits."""
    g = 4 * actuator
    made: float = control * (gains[g] + gains[g + 1] * velocity)
    return min(float(gains[g + 3]), max(float(gains[g + 2]), made))


def drag(gains: Any, actuator: int, control: float, made: float) -> float:
    """How the force of an actuator falls with its velocity; not at its limits."""
    g = 4 * actuator
    return -gains[g + 1] * control if gains[g + 2] < made < gains[g + 3] else 0.0


def load_joints(
    counts: Any,
    paths: Any,
    freedoms: Any,
    pulls: Any,
    motors: Any,
    rows: Any,
    gains: Any,
    damping: Any,
    step: Any,
    ctrl: Any,
    qvel: Any,
    arms: Any,
    ten_velocity: Any,
    actuator_velocity: Any,
    qfrc_bias: Any,
    qfrc_applied: Any,
    actuator_force: Any,
    mass: Any,
    total: Any,
) -> None:
    """Sum the forces of joints and paths. What they lose by damping until the end of the step is added to the mass."""
    h = step[0]
    for i in range(counts[5]):
        total[i] = qfrc_applied[i] - qfrc_bias[i] - damping[i] * qvel[i]
        mass[rows[2 * i] + rows[2 * i + 1] - 1] += h * damping[i]
    for pull in range(counts[2]):
        actuator, path = pulls[2 * pull], pulls[2 * pull + 1]
        made = force(gains, actuator, ctrl[actuator], ten_velocity[path])
        actuator_force[actuator] = made
        for k in range(paths[2 * path], paths[2 * path + 1]):
            total[freedoms[k]] += arms[k] * made
    for motor in range(counts[3]):
        actuator, i = motors[2 * motor], motors[2 * motor + 1]
        made = force(gains, actuator, ctrl[actuator], actuator_velocity[actuator])
        actuator_force[actuator] = made
        total[i] += made
        mass[rows[2 * i] + rows[2 * i + 1] - 1] += h * drag(gains, actuator, ctrl[actuator], made)


def load_contacts(
    counts: Any,
    spheres: Any,
    pushes: Any,
    links: Any,
    rows: Any,
    wrenches: Any,
    gains: Any,
    step: Any,
    ctrl: Any,
    site_xpos: Any,
    xaxis: Any,
    xanchor: Any,
    actuator_velocity: Any,
    actuator_force: Any,
    mass: Any,
    total: Any,
    row: Any,
) -> None:
    """Add the forces of pushes, and their damping to the mass, as `load_joints` does."""
    for sphere in range(counts[4]):
        site, begin, end = 3 * spheres[7 * sphere], spheres[7 * sphere + 5], spheres[7 * sphere + 6]
        px, py, pz = site_xpos[site], site_xpos[site + 1], site_xpos[site + 2]
        for push in range(spheres[7 * sphere + 3], spheres[7 * sphere + 4]):
            actuator, w, size = pushes[push], 7 * push, 0
            control = ctrl[actuator]
            if control == 0.0:
                actuator_force[actuator] = 0.0
                continue
            made = force(gains, actuator, control, actuator_velocity[actuator])
            actuator_force[actuator] = made
            lost = step[0] * drag(gains, actuator, control, made)
            fx, fy, fz = wrenches[w], wrenches[w + 1], wrenches[w + 2]
            for k in range(begin, end):
                first, last = links[3 * k], links[3 * k + 1]
                mx, my, mz = fx, fy, fz
                if links[3 * k + 2] > 0:
                    rx, ry, rz = px - xanchor[3 * first], py - xanchor[3 * first + 1], pz - xanchor[3 * first + 2]
                    mx, my = wrenches[w + 3] + ry * fz - rz * fy, wrenches[w + 4] + rz * fx - rx * fz
                    mz = wrenches[w + 5] + rx * fy - ry * fx
                for i in range(first, last):
                    arm = xaxis[3 * i] * mx + xaxis[3 * i + 1] * my + xaxis[3 * i + 2] * mz
                    total[i] += arm * made
                    row[size] = arm
                    size += 1
                    if lost != 0.0:
                        share, place = lost * arm, rows[2 * i]
                        for other in range(size):
                            mass[place + other] += share * row[other]


def advance(counts: Any, step: Any, acceleration: Any, qpos: Any, qvel: Any) -> None:
    """Semi-implicit Euler: velocities, then coordinates."""
    h = step[0]
    for i in range(counts[5]):
        qvel[i] += h * acceleration[i]
        qpos[i] += h * qvel[i]
