import math

from gaitsim.component import Component, Input, Output, Parameter, State


def biceps_length(clearance, segment, slope, reference):
    """Fiber length of the short head of the biceps at which the leg is as short as the clearance."""
    cosine = (2 * segment * segment - clearance * clearance) / (2 * segment * segment)
    knee = math.acos(max(-1.0, min(1.0, cosine)))
    return 1 + slope * (knee - reference)


class Song2015SwingPhases(Component):
    """Gates of the swing modules M7, M8, M9 and M10, which open one after the other (Song & Geyer 2015).

    M7 flexes the knee until the length of the short head of the biceps shows that the leg is short enough for the
    clearance. Then M8 holds the knee until the length of the rectus femoris shows that the leg reached its target. M9
    stops the leg while the hamstrings are longer than at the target. M10 prepares stance once they shorten again. The
    phases are remembered until the leg is in stance and not about to swing; they take effect one step later.
    """

    clearance = Parameter(
        "m",
        "l_clr: distance of hip and ankle at which M7 ends; beyond a straight leg it ends at once.",
        bounds=(0, 100),
    )
    segment = Parameter("m", "Length of thigh and of shank.", default=0.46, bounds=(0.01, 10), source="songmodel")
    slope = Parameter("1/rad", "Fiber length of the biceps over the angle of the knee.", bounds=(-10, 10))
    reference = Parameter("deg", "Angle of the knee at which it is l_opt.", bounds=(0, 360))
    in_stance = Input("1", "1 while the leg stands.")
    initiation = Input("1", "1 while both legs stand and this one shall swing.")
    biceps_length = Input("1", "Fiber length of the short head of the biceps femoris, in l_opt.")
    rectus_length = Input("1", "Fiber length of the rectus femoris, in l_opt.")
    rectus_target = Input("1", "The one that it has at the target.")
    hamstrings_length = Input("1", "Fiber length of the hamstrings, in l_opt.")
    hamstrings_target = Input("1", "The one that they have at the target.")
    hamstrings_velocity = Input("1", "Fiber velocity of the hamstrings, in v_max.")
    flexed = State(levels=("no", "yes"), doc="Whether the knee has flexed enough.")
    arrived = State(levels=("no", "yes"), doc="Whether the leg has come to its target.")
    beyond = State(levels=("no", "yes"), doc="Whether the hamstrings were longer than at the target.")
    retracting = State(levels=("no", "yes"), doc="Whether they shortened after that.")
    flexion = Output("1", "1 while M7 is open.")
    hold = Output("1", "1 while M8 is open.")
    stop = Output("1", "1 while M9 is open.")
    preparation = Output("1", "1 while M10 is open.")

    @staticmethod
    def output(p, u, x, y):
        swings = u.in_stance < 0.5
        after = swings and x.flexed == 1
        y.flexion = 1.0 if swings and x.flexed == 0 else 0.0
        y.hold = 1.0 if after and x.arrived == 0 else 0.0
        y.stop = 1.0 if after and x.beyond == 1 else 0.0
        y.preparation = 1.0 if after and x.retracting == 1 else 0.0

    @staticmethod
    def update(p, u, x, y, dt):
        swings = u.in_stance < 0.5
        if not swings and u.initiation < 0.5:
            x.flexed, x.arrived, x.beyond, x.retracting = 0, 0, 0, 0
        if swings and u.biceps_length <= biceps_length(p.clearance, p.segment, p.slope, p.reference):
            x.flexed = 1
        if swings and x.flexed == 1:
            if u.rectus_length <= u.rectus_target:
                x.arrived = 1
            if u.hamstrings_length >= u.hamstrings_target:
                x.beyond = 1
            if x.beyond == 1 and u.hamstrings_velocity <= 0:
                x.retracting = 1
