from gaitsim.component import Component, Input, Output, Parameter


class Hop(Component):
    """Negative height of recurring hops, corrected for the height that energy stored at the start could give.

    Candidates with too few or irregular hops have a positive cost, which decreases as they come closer to
    hopping. Below 1: enough hops, but their apexes differ. Above 1: too few hops.
    """

    required_hops = Parameter(
        "1",
        "Fewer hops are a failure.",
        default=5,
        bounds=(1, 100),
        source="definition: five show whether hops recur",
        whole=True,
    )
    largest_spread = Parameter(
        "m", "Apexes that differ by more are a failure.", default=0.01, bounds=(1e-6, 1), source="definition: 1 cm"
    )
    correction = Parameter(
        "1",
        "Share of the stored height that is subtracted; with 0, a search can gain height by pre-loading the tendon.",
        default=1,
        bounds=(0, 1),
        source="thesis: energy stored in the tendon at the start",
    )
    scale = Parameter(
        "m", "Height that corresponds to a cost of 1.", default=1, bounds=(1e-3, 1e3), source="definition: SI"
    )
    patience = Parameter(
        "s",
        "Time upright at which half of its share of the cost is gone.",
        default=1,
        bounds=(1e-3, 1e3),
        source="definition: about a hop",
    )
    height = Input("m", "Mean height of the last hops.")
    spread = Input("m", "Highest minus lowest of the last apexes.")
    hops = Input("1", "Number of hops.")
    rebound = Input("1", "Rise after the first touchdown, relative to the fall, 0 to 1.", default=0)
    upright = Input("s", "Time upright.", default=0)
    stored_height = Input("m", "Height that energy stored at the start could give.", default=0)
    cost = Output("1", "Cost: the negative height in units of scale.")

    @staticmethod
    def output(p, u, x, y):
        missing = p.required_hops - u.hops
        excess = u.spread - p.largest_spread
        if missing > 0:
            y.cost = 1 + missing - 0.5 * u.rebound - 0.5 * u.upright / (u.upright + p.patience)
        elif excess > 0:
            y.cost = excess / (excess + p.largest_spread)
        else:
            y.cost = -(u.height - p.correction * u.stored_height) / p.scale
