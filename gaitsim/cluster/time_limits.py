"""Time limits of candidates, and the verdict of a candidate that exceeded one."""

from __future__ import annotations

from dataclasses import dataclass

from gaitsim.optimization.evaluation import Candidate, Evaluation, Verdict

TimedEvaluation = tuple[Evaluation, float, str]  # with its seconds, and the host


@dataclass(frozen=True)
class TimeLimits:
    """Time limits in seconds. They are long, because no score may depend on the speed of a machine."""

    first: float = 3600.0  # for a candidate, while none is known
    least: float = 60.0  # for a candidate, and so many times the mean of the others
    times: float = 20.0
    workers: float = 60.0  # without any worker


@dataclass
class Pace:
    """The running mean of the time of one evaluation."""

    time_limits: TimeLimits
    mean: float | None = None

    def learn(self, seconds: float) -> None:
        self.mean = seconds if self.mean is None else 0.9 * self.mean + 0.1 * seconds

    @property
    def limit(self) -> float:
        """The time limit of one candidate, in s."""
        limits = self.time_limits
        return limits.first if self.mean is None else limits.least + limits.times * self.mean

    def fitting(self, seconds: float) -> int:
        """The number of evaluations that fit into a time in s; 0 while the mean is unknown."""
        return 0 if self.mean is None else int(seconds / max(self.mean, 1e-6))


def killed(candidate: Candidate) -> TimedEvaluation:
    """The result of a candidate that made its workers die."""
    return _given_up(candidate, "killed", "this candidate killed every worker that tried it")


def too_late(candidate: Candidate) -> TimedEvaluation:
    """The result of a candidate that exceeded its time."""
    return _given_up(candidate, "timeout", "this candidate was not done after many times what the others took")


def _given_up(candidate: Candidate, status: str, reason: str) -> TimedEvaluation:
    return Evaluation(candidate, Verdict(status, reason, None, {}, 0.0, 0)), 0.0, ""
