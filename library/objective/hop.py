from gaitsim.component import Component, Input, Output, Parameter


class Hop(Component):
    """Minus the height of recurring hops, less the height that energy stored at the start could give.

    What does not hop often enough, or not recurringly, fails by degrees: cost is positive and the
    smaller, the less is missing. Below 1: enough hops, but their apexes differ. Above 1: hops are missing.
    """

    required_hops = Parameter(
        "1", "Fewer hops are a failure.", default=5, bounds=(1, 100), source="definition: five tell whether hops recur"
    )
    largest_spread = Parameter(
        "m", "Apexes that differ by more are a failure.", default=0.01, bounds=(1e-6, 1), source="definition: 1 cm"
    )
    correction = Parameter(
        "1",
        "Share of the stored height that is taken off; 0 lets a search pre-load the tendon.",
        default=1,
        bounds=(0, 1),
        source="thesis: energy stored in the tendon at the start",
    )
    scale = Parameter(
        "m", "Height that is worth one unit of cost.", default=1, bounds=(1e-3, 1e3), source="definition: SI"
    )
    patience = Parameter(
        "s", "Time upright that counts half.", default=1, bounds=(1e-3, 1e3), source="definition: about a hop"
    )
    height = Input("m", "Mean height of the last hops.")
    spread = Input("m", "Highest minus lowest of the last apexes.")
    hops = Input("1", "Number of hops.")
    rebound = Input("1", "How far it came up again after the first touchdown, 0 to 1.", default=0)
    upright = Input("s", "How long it stayed up.", default=0)
    stored_height = Input("m", "Height that energy stored at the start could give.", default=0)
    cost = Output("1", "The cost: metres of height, negative.")

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
