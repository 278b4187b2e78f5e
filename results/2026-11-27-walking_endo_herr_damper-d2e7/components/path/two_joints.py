from gaitsim.component import Component, Input, Output, Parameter, Part


class TwoJoints(Component):
    """A path across two joints, such as that of the gastrocnemius, from one inner path per joint.

    l = l_1 + l_2 - l_ref, where both inner paths have the same l_ref. Both carry the
    whole tension.
    """

    reference_length = Parameter(
        "m",
        "Length l_ref where both joints are at their reference angles; by default the sum of optimal fiber length and "
        "tendon slack length.",
        bounds=(0, 3),
    )
    first = Part(
        "path",
        "The path around one joint.",
        default="path/cosine_arm",
        reads=(("first_length", "length"), ("first_velocity", "velocity")),
        sends=(("tension", "tension"),),
        gives=(("reference_length", "reference_length"),),
    )
    second = Part(
        "path",
        "The path around the other joint.",
        default="path/cosine_arm",
        reads=(("second_length", "length"), ("second_velocity", "velocity")),
        sends=(("tension", "tension"),),
        gives=(("reference_length", "reference_length"),),
    )
    tension = Input("N", "Force along the path, positive in tension.", sums=True)
    first_length = Input("m", "Length of the first inner path.")
    first_velocity = Input("m/s", "Lengthening velocity of the first inner path.")
    second_length = Input("m", "Length of the second inner path.")
    second_velocity = Input("m/s", "Lengthening velocity of the second inner path.")
    length = Output("m", "Length of the path.")
    velocity = Output("m/s", "Lengthening velocity of the path.")

    @staticmethod
    def output(p, u, x, y):
        y.length = u.first_length + u.second_length - p.reference_length
        y.velocity = u.first_velocity + u.second_velocity
