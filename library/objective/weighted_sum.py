from gaitsim.component import Component, Input, Output, Parameter


class WeightedSum(Component):
    """Weighted sum of terms, each an objective with its own name and weight.

    terms:
      effort: {use: objective/minimize, value: {from: effort}}
      speed: {use: objective/deviation, value: {from: speed}, target: 1.3 m/s, tolerance: 0.1 m/s, weight: 100}
    """

    scale = Parameter(
        "1", "Sum that corresponds to a cost of 1.", default=1, bounds=(1e-9, 1e9), source="definition: unscaled"
    )
    terms = Input("1", "The costs of its terms.", sums=True)
    cost = Output("1", "Their sum over `scale`.")

    @staticmethod
    def output(p, u, x, y):
        y.cost = u.terms / p.scale
