"""Why candidates failed is counted by kind: the same words with other numbers are one kind."""

from __future__ import annotations

from gaitsim.optimization.evaluation import Candidate, Evaluation, Verdict
from gaitsim.optimization.failures import Failures, reason_of

REASONS = (
    ("failed", "the mechanics diverged in knee_l.angle at 0.31 s; try a shorter step"),
    ("failed", "trap (trap/raises) raised in update at 2 s (components/trap/raises.py:27): ValueError: too much"),
    ("failed", "the mechanics diverged in knee_l.angle at 1.5e-05 s; try a shorter step"),
    ("failed", "the mechanics diverged in knee_r.angle at 0.31 s; try a shorter step"),
    ("killed", "this candidate killed every worker that tried it"),
    ("failed", "a gives no finite number in output at 1 s: force = nan, length = -inf"),
    ("failed", "a gives no finite number in output at 2.25 s: force = nan, length = 3"),
    ("failed", "the mechanics diverged in knee_l.angle at 4 s; try a shorter step"),
    ("completed", ""),
    ("stopped", "upright"),
    ("stopped", "upright"),
)


def test_kinds_are_counted_and_the_first_is_the_example() -> None:
    failures = Failures()
    for i, (status, reason) in enumerate(REASONS):
        failures.add(Evaluation(Candidate(1, i, (0.0,)), Verdict(status, reason, None, {}, 0.0, 0)))
    found = [(count, example.candidate.name) for count, example in failures.most_common]
    assert found == [(3, "1:0"), (2, "1:5"), (2, "1:9"), (1, "1:1"), (1, "1:3"), (1, "1:4"), (1, "1:8")]
    assert reason_of(failures.most_common[-1][1]) == "there was no score"
    assert reason_of(failures.most_common[2][1]) == "stopped by upright, without a score"
    assert reason_of(failures.most_common[0][1]) == REASONS[0][1]
