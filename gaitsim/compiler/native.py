"""The native code of a plan: arguments and results of its functions."""

from __future__ import annotations

# What `run` returns: all steps are done, something is not finite or raised, the mechanics diverged,
# or a part has stopped the run (STOPPED + which of the plan's stops).
COMPLETED, SUSPECT, DIVERGED, STOPPED = 0, 1, 2, 3
# Sizes of tables of states and outputs are multiples of this, so that they are checked in blocks.
PADDING = 32

# Largest number of events in a step, and of halvings to locate one.
EVENTS, HALVINGS = 64, 44
# Where each stage of Runge-Kutta 4 begins, as a share of the step, and the weight of its rates.
RUNGE_KUTTA = ((0.0, 1.0), (0.5, 2.0), (0.5, 2.0), (1.0, 1.0))

# What functions are given, each an integer, a number (a double), a pointer to a table of its own, or a pointer
# into what others reach as well. First what all of a step get: its number and length, the tables, and the past
# of delayed signals: rows of one number for each line, a power of two of them, and each line's delay in steps.
_TABLES = {
    "dt": "number",
    "parameters": "pointer",
    "base": "pointer",
    "states": "pointer",
    "outputs": "pointer",
    "past": "pointer",
    "mask": "integer",
    "whole": "pointer",
    "rest": "pointer",
}
FRAME = {"step": "integer", **_TABLES}
# Addresses of what is read and written in MuJoCo's data; values before the start; initial values of states;
# addresses for the stages of MuJoCo's step that gaitsim makes itself.
START = {
    **_TABLES,
    "ties": "pointer",
    "before": "pointer",
    "places": "pointer",
    "values": "pointer",
    "count": "integer",
    "rounds": "integer",
}
RUN = {
    **_TABLES,
    "ties": "pointer",
    "written": "pointer",
    "first": "integer",
    "steps": "integer",
    "model": "shared",
    "data": "shared",
    "stages": "shared",
    "qpos": "shared",
    "qvel": "shared",
    "fastest": "number",
    "record": "pointer",
    "reached": "pointer",
}


# The stages to which the functions of MuJoCo belong. "other mechanics" are functions of several stages.
STAGE_OF = {
    "mj_kinematics": "kinematics",
    "mj_comPos": "kinematics",
    "mj_tendon": "kinematics",
    "mj_makeM": "inertia",
    "mj_factorM": "inertia",
    "mj_transmission": "transmission",
    "mj_comVel": "velocity",
    "mj_rne": "velocity",
    "mj_subtreeVel": "velocity",
    "mj_fwdVelocity": "velocity",
    "mj_sensorPos": "sensors",
    "mj_sensorVel": "sensors",
    "mj_energyPos": "energy",
    "mj_energyVel": "energy",
    "mj_fwdActuation": "actuation",
    "mj_fwdAcceleration": "acceleration",
    "mj_solveM": "acceleration",
    "mj_fwdConstraint": "solver",
    "mj_Euler": "integration",
    "mj_implicit": "integration",
    **dict.fromkeys(("mj_step1", "mj_step2", "mj_forwardSkip", "mj_RungeKutta"), "other mechanics"),
}
# Of code with a stopwatch: its table of ticks and then of intervals, for each part and then for these, and the function
# that tells the tick.
TICKS, CLOCK = "ticks", "clock"
TIMED = (*dict.fromkeys(STAGE_OF.values()), "own stages", "reading", "steps")


def padded(size: int) -> int:
    """The size of a table that is checked as a whole."""
    return -(-size // PADDING) * PADDING
