from gaitsim.component import Component, Curve, Input, Output, Parameter


class Inhibition(Component):
    """Inhibition of a muscle by a delayed signal: S = -G (P - P_off), gated.

    In Geyer & Herr (2010): the soleus' force from the tibialis anterior, G_SOLTA F_SOL; the length
    of the hamstrings from the hip flexors, G_HAMHFL (l_HAM - l_off,HAM); the other leg's load from
    the vasti in double support, k_bw |F_contra| DSup. In their author's release of 2006 the stretch
    l_HAM - l_off,HAM is never below 0 (`least: 0`): short hamstrings do not excite the hip flexors.
    """

    gain = Parameter("1", "G: stimulation subtracted per unit of the signal.", bounds=(0, 100))
    offset = Parameter(
        "1",
        "P_off: signal at which there is no inhibition.",
        default=0,
        bounds=(-10, 10),
        source="geyer2010, inhibition by force and by load",
    )
    least = Parameter(
        "1",
        "Lower bound of G (P - P_off); with 0, a signal below P_off has no effect.",
        default=-1e6,
        bounds=(-1e6, 0),
        source="definition: a signal below P_off excites",
    )
    signal = Input("1", "Normalized force or length of another muscle, or a load in body weights.")
    gate = Input("1", "1 enables the inhibition; 0 disables it.", default=1)
    stimulation = Output("1", "Contribution to the inhibited muscle's excitation; negative.")

    answer = Curve("stimulation", "signal", (0, 1.5), "Stimulation over the signal, G = 0.3.", at={"gain": 0.3})

    @staticmethod
    def output(p, u, x, y):
        y.stimulation = -u.gate * max(p.least, p.gain * (u.signal - p.offset))
