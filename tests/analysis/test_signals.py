"""Signals are found by address and pattern, and what is none is said with what is near."""

from __future__ import annotations

import pytest

from gaitsim.analysis.signals.pattern import NoSuchSignal, matching
from gaitsim.model import Model, recorded_signals

from .swinging import model


@pytest.fixture(scope="module")
def swinging() -> Model:
    return model()


def addresses(swinging: Model, text: str, arriving: bool = False) -> list[str]:
    return [signal.address for signal in matching(swinging, text, arriving)]


def test_outputs_and_plain_states_are_signals(swinging: Model) -> None:
    known = {signal.address: signal for signal in recorded_signals(swinging)}
    assert list(known) == [
        "pivot.angle",
        "pivot.velocity",
        "brake.torque",
        "brake.accumulated",
        "watch.turned",
        "watch.side",
    ]
    assert (known["brake.accumulated"].unit, known["brake.accumulated"].doc) == ("rad s", "Integral of the error.")
    assert known["watch.side"].levels == ("left", "right")
    # What is recorded is SI, whatever the declaration's unit is.
    assert known["watch.turned"].unit == "rad"


def test_addresses_and_patterns(swinging: Model) -> None:
    assert addresses(swinging, "pivot.angle") == ["pivot.angle"]
    assert addresses(swinging, "pivot.*") == ["pivot.angle", "pivot.velocity"]
    assert addresses(swinging, "*.a*") == ["pivot.angle", "brake.accumulated"]
    assert addresses(swinging, "?rake.[t]*") == ["brake.torque"]
    assert addresses(swinging, "*.torque") == ["brake.torque"]


def test_inputs_are_signals_where_they_are_named(swinging: Model) -> None:
    assert addresses(swinging, "pivot.torque", arriving=True) == ["pivot.torque"]
    assert addresses(swinging, "*.torque", arriving=True) == ["brake.torque", "pivot.torque"]
    assert addresses(swinging, "pivot.*", arriving=True) == ["pivot.angle", "pivot.velocity"]


MISSING = {
    "pivot.angel": "there is no such signal; the nearest are pivot.angle, pivot.velocity.",
    "angle": "there is no such signal; the nearest are pivot.angle.",
    "pivot": "this is a part; its signals are pivot.angle, pivot.velocity; or write 'pivot.*'.",
    "pivot.torque": "this is an input, and outputs and states are recorded; it comes from brake.torque.",
    "brake.limit": "this is a parameter, which stays what it is during a run; see gaitsim show --parameters.",
    "watch.samples": "this is a list of numbers, which is not recorded; outputs and plain states are.",
    "swing.lowest": "this is the inside of a measure, which is not recorded; outputs and plain states are.",
    "*.forse": "no signal of swinging matches this; signals are such as "
    "pivot.angle, pivot.velocity, brake.torque, brake.accumulated, watch.turned.",
    "pivot.ang?": "no signal of swinging matches this; signals are such as pivot.angle, pivot.velocity.",
}


@pytest.mark.parametrize("text", MISSING)
def test_what_is_no_signal(text: str, swinging: Model) -> None:
    with pytest.raises(NoSuchSignal) as error:
        matching(swinging, text)
    assert str(error.value) == f"{text}: {MISSING[text]}"
    assert error.value.exit_code == 2
