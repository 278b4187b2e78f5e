from gaitsim.component import Component, Input, Output, Parameter, State


class ClutchGates(Component):
    """Gates of the clutches in a leg of the Endo-Herr type, from leg phase, leg direction and knee angle.

    Endo & Herr (2009) engage and release clutches by the state of the joints. Their rules are not published, so these
    rules are our own. The leg's direction is a = phi_hip - phi_knee / 2, which is 90 deg if the leg is under an
    upright trunk, and less in front of it; all angles grow in extension (Geyer & Herr 2010).

    vastus: in stance, until the other leg has landed. gastrocnemius: in stance beyond a direction. rectus femoris:
    in stance beyond a direction, and in swing until the hamstrings are engaged. hamstrings and the short head of
    the biceps femoris: engaged in swing once the knee extends and is beyond an angle; released in stance
    beyond a direction.
    """

    gastrocnemius_direction = Parameter("rad", "a_GAS: direction beyond which it is engaged.", bounds=(0, 3.15))
    rectus_femoris_direction = Parameter("rad", "a_RF: direction beyond which it is engaged.", bounds=(0, 3.15))
    hamstrings_release = Parameter("rad", "a_HAM: direction that releases both knee flexors.", bounds=(0, 3.15))
    hamstrings_knee = Parameter("rad", "k_HAM: knee angle beyond which they are engaged.", bounds=(0, 3.15))
    biceps_femoris_knee = Parameter("rad", "k_BFSH: knee angle beyond which it is engaged.", bounds=(0, 3.15))

    hip_angle = Input("rad", "phi_hip: 180 deg upright, grows in extension.")
    knee_angle = Input("rad", "phi_knee: 180 deg straight, grows in extension.")
    knee_angular_velocity = Input("rad/s", "Its rate.")
    in_stance = Input("1", "1 while the leg stands.")
    in_double_support = Input("1", "1 while both legs stand and the other landed last.")

    hamstrings_engaged = State(levels=("no", "yes"), doc="Whether the hamstrings' clutch is engaged.")
    biceps_femoris_engaged = State(levels=("no", "yes"), doc="Whether the clutch of the short head is engaged.")

    direction = Output("rad", "a: direction of the leg.")
    vastus = Output("1", "1 engages the vastus.")
    gastrocnemius = Output("1", "1 engages the gastrocnemius.")
    rectus_femoris = Output("1", "1 engages the rectus femoris.")
    hamstrings = Output("1", "1 engages the hamstrings.")
    biceps_femoris = Output("1", "1 engages the short head of the biceps femoris.")

    @staticmethod
    def output(p, u, x, y):
        stands = u.in_stance > 0.5
        y.direction = u.hip_angle - 0.5 * u.knee_angle
        y.vastus = 1.0 if stands and u.in_double_support < 0.5 else 0.0
        y.gastrocnemius = 1.0 if stands and y.direction > p.gastrocnemius_direction else 0.0
        beyond, waits = y.direction > p.rectus_femoris_direction, x.hamstrings_engaged < 0.5
        y.rectus_femoris = 1.0 if (stands and beyond) or (not stands and waits) else 0.0
        y.hamstrings = 1.0 if x.hamstrings_engaged > 0.5 else 0.0
        y.biceps_femoris = 1.0 if x.biceps_femoris_engaged > 0.5 else 0.0

    @staticmethod
    def update(p, u, x, y, dt):
        stands = u.in_stance > 0.5
        extends = not stands and u.knee_angular_velocity > 0
        if stands and y.direction > p.hamstrings_release:
            x.hamstrings_engaged = 0
            x.biceps_femoris_engaged = 0
        if extends and u.knee_angle > p.hamstrings_knee:
            x.hamstrings_engaged = 1
        if extends and u.knee_angle > p.biceps_femoris_knee:
            x.biceps_femoris_engaged = 1
