"""How long a candidate may take, and what is said of one that was given up."""

from __future__ import annotations

from dataclasses import dataclass

from gaitsim.optimization.evaluation import Candidate, Evaluation, Verdict

Found = tuple[Evaluation, float, str]  # with its seconds, and the host


@dataclass(frozen=True)
class Patience:
    """Seconds until something is given up. They are long: no score may depend on how fast a machine is."""

    first: float = 3600.0  # for a candidate, while none is known
    least: float = 60.0  # for a candidate, and so many times the mean of the others
    times: float = 20.0
    workers: float = 60.0  # without any worker


@dataclass
class Pace:
    """The running mean of the seconds of one evaluation, and what follows from it."""

    patience: Patience
    mean: float | None = None

    def learn(self, seconds: float) -> None:
        self.mean = seconds if self.mean is None else 0.9 * self.mean + 0.1 * seconds

    @property
    def limit(self) -> float:
        """How long one candidate may take, in seconds."""
        return self.patience.first if self.mean is None else self.patience.least + self.patience.times * self.mean

    def fitting(self, seconds: float) -> int:
        """How many evaluations are done in a time; 0 while it is not known."""
        return 0 if self.mean is None else int(seconds / max(self.mean, 1e-6))


def killed(candidate: Candidate) -> Found:
    """A candidate whose workers died of it."""
    return _given_up(candidate, "killed", "this candidate killed every worker that tried it")


def too_late(candidate: Candidate) -> Found:
    """A candidate that did not come back."""
    return _given_up(candidate, "timeout", "this candidate was not done after many times what the others took")


def _given_up(candidate: Candidate, status: str, reason: str) -> Found:
    return Evaluation(candidate, Verdict(status, reason, None, {}, 0.0, 0)), 0.0, ""
