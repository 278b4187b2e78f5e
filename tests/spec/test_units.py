"""Units as text: what each is worth in SI, and what is not a unit."""

from __future__ import annotations

import math
import re

import pytest

from gaitsim.units import Dimension, UnknownUnit, known_units, parse_unit

VALUES = {
    "kg": (1, "mass"),
    "g": (1e-3, "mass"),
    "mm": (1e-3, "length"),
    "deg": (math.pi / 180, "angle"),
    "degrees": (math.pi / 180, "angle"),
    "%": (0.01, ""),
    "1/min": (1 / 60, "1/time"),
    "kN/m": (1000, "mass/time^2"),
    "MPa": (1e6, "mass/(length time^2)"),
    "N m/deg": (180 / math.pi, "length^2 mass/(time^2 angle)"),
    "J/(kg m)": (1, "length/time^2"),
    "N m/(rad s)": (1, "length^2 mass/(time^3 angle)"),
    "W / kg": (1, "length^2/time^3"),
    "N/m s": (1, "mass/time"),
    "kg*m**2": (1, "length^2 mass"),
    "s^-1": (1, "1/time"),
    "m^(1/2)": (1, "length^1/2"),
    "cm^3": (1e-6, "length^3"),
}
REFUSED = ("Ns", "newtonmeter", "2 m", "60/s", "m//s", "/s", "(m", "m)", "m^", "m^s", "m^(1/0)", "m^2.5", "m,s", " ")


def test_each_unit_is_worth_its_si_value_and_has_its_dimension() -> None:
    found = {text: (parse_unit(text).factor, parse_unit(text).dimension.formula) for text in VALUES}
    assert found == VALUES


def test_what_is_no_product_of_known_units_is_refused_with_its_text() -> None:
    for text in REFUSED:
        with pytest.raises(UnknownUnit, match=f"^{re.escape(text)}$"):
            parse_unit(text)


def test_the_units_that_errors_suggest_are_units() -> None:
    assert all(parse_unit(text).dimension != Dimension() or text == "%" for text in known_units())
