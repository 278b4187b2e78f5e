from gaitsim.component import Component, Input, Metric, Output, Parameter, State

UPRIGHT, DOWN, FORWARDS, BACKWARDS, RIGHT, LEFT = 0.0, 1.0, 2.0, 3.0, 4.0, 5.0


def way_of(down, lean, side_lean, lean_share, side_share):
    """Direction of the fall: the lean that is furthest beyond its limit, or straight down."""
    if down and lean_share < 0.5 and side_share < 0.5:
        return DOWN
    if side_share > lean_share:
        return RIGHT if side_lean > 0 else LEFT
    return FORWARDS if lean > 0 else BACKWARDS


class SpatialFall(Component):
    """Detects a fall, when a height is below a limit or the trunk leans too far to any side, and ends the run.

    It also reports the direction: that in which the trunk leans by more than half of the limit when the height is
    below its limit. The run ends one step after the fall.
    """

    below = Parameter("m", "The run ends below this height.", bounds=(-10, 10))
    beyond = Parameter(
        "rad",
        "The run ends if the trunk leans further, forwards or backwards.",
        default=1.05,
        bounds=(0.01, 10),
        source="definition: 60 deg",
    )
    beyond_sideways = Parameter(
        "rad",
        "The run ends if the trunk leans further to a side.",
        default=0.7,
        bounds=(0.01, 10),
        source="definition: 40 deg",
    )
    height = Input("m", "Height that must stay above the limit.")
    lean = Input("rad", "Forward lean of the trunk.")
    side_lean = Input("rad", "Lean of the trunk to its right.")
    steps = State("1", "Steps since the start.")
    time = State("s", "Time since the start, until the fall.")
    fallen = State(
        levels=("upright", "fell_down", "fell_forwards", "fell_backwards", "fell_to_the_right", "fell_to_the_left"),
        doc="Whether it fell, and in which direction.",
    )
    stop = Output("1", "1 ends the run.")

    value = Metric("s", "Time until the fall; without a fall, the duration of the run.")
    fell = Metric("1", "1 if it fell, else 0.")
    fell_sideways = Metric("1", "1 if it fell to a side, else 0.")

    @staticmethod
    def output(p, u, x, y):
        y.stop = 1.0 if x.fallen > UPRIGHT else 0.0

    @staticmethod
    def update(p, u, x, y, dt):
        lean_share, side_share = abs(u.lean) / p.beyond, abs(u.side_lean) / p.beyond_sideways
        down = u.height < p.below
        if down or lean_share > 1 or side_share > 1:
            x.fallen = way_of(down, u.lean, u.side_lean, lean_share, side_share)
        else:
            x.steps = x.steps + 1
        x.time = x.steps * dt

    @staticmethod
    def finish(p, x, m):
        m.value = x.time
        m.fell = 1.0 if x.fallen > UPRIGHT else 0.0
        m.fell_sideways = 1.0 if x.fallen >= RIGHT else 0.0
