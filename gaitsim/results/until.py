"""What ends a range of values: runs that do not complete, or a metric that reaches a value."""

from __future__ import annotations

import math
from dataclasses import dataclass

from gaitsim.errors import Usage, did_you_mean
from gaitsim.model import Model
from gaitsim.simulation.outcome import Outcome
from gaitsim.spec.inheritance import split_setting
from gaitsim.text.quantity import BadQuantity, quantity_of
from gaitsim.units import parse_unit, with_unit


@dataclass(frozen=True)
class Until:
    """What ends a range: runs that do not complete, or a metric that reaches a value.

    Attributes:
        value: In the unit of the metric.
    """

    metric: str = ""
    value: float = math.nan
    unit: str = "1"

    def holds(self, outcome: Outcome, at_first: Outcome) -> bool:
        """Whether a run still succeeds, given the run at the first end of the range. A failed run never does."""
        if outcome.status == "failed" or not self.metric:
            return outcome.status == "completed"
        side = self._distance(at_first)
        return side * self._distance(outcome) > 0

    def ending_of(self, outcome: Outcome) -> str:
        """How a run ended, in words."""
        if outcome.status == "failed":
            return f"failed: {outcome.reason}"
        if self.metric:
            return f"{self.metric} = {with_unit(f'{outcome.metrics.get(self.metric, math.nan):.5g}', self.unit)}"
        if outcome.status == "stopped":
            return f"{outcome.reason} at {outcome.simulated_seconds:.4g} s"
        return outcome.status

    def _distance(self, outcome: Outcome) -> float:
        return outcome.metrics.get(self.metric, math.nan) - self.value


def until_of(text: str | None, model: Model) -> Until:
    """Read `--until METRIC=VALUE`.

    Raises:
        Usage: It is not of this form, or there is no such metric.
    """
    if text is None:
        if not any(part.measure and "stop" in part.type.outputs for part in model.parts):
            rule = "no measure of this spec ends a run"
            raise Usage(f"{rule}; say what does: --until METRIC=VALUE, or add one such as use: measure/fall.")
        return Until()
    metric, value = split_setting(text, "--until")
    if metric not in model.metrics:
        raise Usage(f"--until {text}: {metric} is not a metric of this spec. {did_you_mean(metric, model.metrics)}")
    unit = parse_unit(model.metrics[metric])
    try:
        quantity = quantity_of(value, unit.text)
    except BadQuantity as error:
        raise Usage(f"--until {text}: {error}") from error
    return Until(metric, quantity.value / unit.factor, unit.text)
