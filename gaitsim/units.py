"""Units of the text outside, SI inside: "30 deg" becomes a number and a dimension."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from fractions import Fraction
from functools import cache

_BASES = ("length", "mass", "time", "angle", "temperature", "current", "any")
_ANGLE = _BASES.index("angle")

# The field's units and no others: a short list that errors can print. SI brochure, 9th edition.
# Each has a name, and is a multiple of a base unit or of other units.
_DEFINITIONS: dict[str, tuple[str, float, str]] = {
    "m": ("meter", 1.0, "length"),
    "g": ("gram", 1e-3, "mass"),
    "s": ("second", 1.0, "time"),
    "rad": ("radian", 1.0, "angle"),
    "K": ("kelvin", 1.0, "temperature"),
    "A": ("ampere", 1.0, "current"),
    "min": ("minute", 60.0, "s"),
    "h": ("hour", 3600.0, "s"),
    "deg": ("degree", math.pi / 180, "rad"),
    "%": ("percent", 0.01, "1"),
    "Hz": ("hertz", 1.0, "1/s"),
    "N": ("newton", 1.0, "kg m/s^2"),
    "J": ("joule", 1.0, "N m"),
    "W": ("watt", 1.0, "J/s"),
    "Pa": ("pascal", 1.0, "N/m^2"),
}
_PREFIXES = {"M": ("mega", 1e6), "k": ("kilo", 1e3), "c": ("centi", 1e-2), "m": ("milli", 1e-3), "u": ("micro", 1e-6)}
_NAMES = (
    *("m", "cm", "mm", "km", "g", "kg", "s", "ms", "min", "h", "rad", "deg", "N", "kN", "J", "kJ", "W", "kW"),
    *("Pa", "kPa", "MPa", "Hz", "K", "A", "%"),
)

_SAID = {
    "": "a plain number",
    "any": "any quantity",
    "length": "a length",
    "mass": "a mass",
    "time": "a time",
    "angle": "an angle",
    "1/time": "a rate",
    "angle/time": "an angular velocity",
    "length/time": "a velocity",
    "length/time^2": "an acceleration",
    "length mass/time^2": "a force",
    "length^2 mass/time^2": "a moment or an energy",
    "length^2 mass/time^3": "a power",
    "length^2 mass": "a moment of inertia",
    "mass/time^2": "a stiffness",
    "mass/time": "a damping",
    "mass/(length time^2)": "a pressure",
    "length^2": "an area",
}


class UnknownUnit(ValueError):
    """A text that is not a known unit."""


@dataclass(frozen=True)
class Dimension:
    """Exponents of length, mass, time, angle, temperature and current, and of `any` for a unit that is left open."""

    exponents: tuple[Fraction, ...] = (Fraction(0),) * len(_BASES)

    def __mul__(self, other: Dimension) -> Dimension:
        return Dimension(tuple(a + b for a, b in zip(self.exponents, other.exponents, strict=True)))

    def __truediv__(self, other: Dimension) -> Dimension:
        return self * other**-1

    def __pow__(self, power: float | Fraction) -> Dimension:
        exact = Fraction(power).limit_denominator(1000)
        return Dimension(tuple(a * exact for a in self.exponents))

    @property
    def without_angle(self) -> Dimension:
        """The dimension with rad = 1, as the audit needs it: otherwise r*theta would not be a length."""
        if not self.exponents[_ANGLE]:
            return self
        return Dimension((*self.exponents[:_ANGLE], Fraction(0), *self.exponents[_ANGLE + 1 :]))

    @property
    def plain(self) -> bool:
        return not any(self.exponents)

    @property
    def formula(self) -> str:
        """Base quantities with powers, such as length mass/time^2."""
        signed = list(zip(_BASES, self.exponents, strict=True))
        over = " ".join(_power(base, e) for base, e in signed if e > 0)
        below = [_power(base, -e) for base, e in signed if e < 0]
        under = f"({' '.join(below)})" if len(below) > 1 else "".join(below)
        return f"{over or '1'}/{under}" if under else over

    def __str__(self) -> str:
        """The name of the quantity with its article, such as a force; the formula if it has no name."""
        return _SAID.get(self.formula, f"a quantity of {self.formula}")

    @property
    def si(self) -> str:
        """The SI unit of this dimension, made of base units."""
        names = dict(zip(_BASES, ("m", "kg", "s", "rad", "K", "A", "*"), strict=True))
        text = self.formula
        for base, name in names.items():
            text = re.sub(rf"\b{base}\b", name, text)
        return text or "1"


ANY = Dimension(tuple(Fraction(base == "any") for base in _BASES))


def _power(base: str, exponent: Fraction) -> str:
    return base if exponent == 1 else f"{base}^{exponent}"


@dataclass(frozen=True)
class Unit:
    """A unit: its text, the SI value of one of it, and its dimension."""

    text: str
    factor: float
    dimension: Dimension

    @property
    def noun_phrase(self) -> str:
        return str(self.dimension)

    @property
    def si(self) -> str:
        """The SI unit of the same quantity, word by word, such as N/m for N/cm."""
        if self.factor == 1:
            return self.text
        return "1" if self.dimension.plain else re.sub(r"[A-Za-z%]+", lambda word: _coherent(word[0]), self.text)

    def to_si(self, number: float) -> float:
        """Convert a number in this unit to SI."""
        return scaled(number, self.factor)

    def of(self, value: float) -> float:
        """Convert a value in SI to this unit.

        Returns:
            The shortest number that converts back to the value bit for bit. Some values have none (every tenth angle
                between
            1 and 2 deg); the nearest number is returned for these.
        """
        if self.factor == 1 or not math.isfinite(value):
            return value
        near = value / self.factor
        for digits in range(1, 18):
            short = float(f"{near:.{digits}g}")
            if self.to_si(short) == value:
                return short
        around = (math.nextafter(near, -math.inf), math.nextafter(near, math.inf))
        return next((number for number in around if self.to_si(number) == value), near)

    def exactly(self, value: float) -> str:
        """A value in SI as text that reads back bit for bit: in this unit, or in SI if no number in this unit does."""
        number = self.of(value)
        return with_unit(repr(number), self.text) if self.to_si(number) == value else with_unit(repr(value), self.si)

    def shown(self, value: float) -> str:
        """A value in SI as text for people, such as 5 deg."""
        return with_unit(f"{self.of(value):g}", self.text)

    def span(self, low: float, high: float) -> str:
        """A range in SI as text for people, such as 5 to 40 deg."""
        return with_unit(f"{self.of(low):g} to {self.of(high):g}", self.text)


def with_unit(number: str, unit: str) -> str:
    """A number and its unit as text; a plain number has no unit."""
    return number if unit == "1" else f"{number} {unit}"


def _coherent(word: str) -> str:
    """The SI unit of one word: Pa for MPa, kg for g, rad for deg, 1 for %."""
    unit, bare = parse_unit(word), word[1:]
    if unit.factor == 1:
        return word
    try:
        return bare if parse_unit(bare).factor == 1 and bare else unit.dimension.si
    except UnknownUnit:
        return unit.dimension.si


@cache
def parse_unit(text: str) -> Unit:
    """Read a unit.

    Args:
        text: Such as N, kg m^2, m/s^2, deg/s, %, 1; `*` leaves the unit open.

    Raises:
        UnknownUnit: The text is not a unit.
    """
    if text in ("", "1"):
        return Unit("1", 1.0, Dimension())
    if text == "*":
        return Unit("*", 1.0, ANY)
    try:
        factor, dimension = _Reader(text).whole()
    except (LookupError, ValueError, ArithmeticError) as error:
        raise UnknownUnit(text) from error
    return Unit(text, _shortest(factor), dimension)


_TOKEN = re.compile(r"\s*([A-Za-z]+|[0-9]+|%|\*\*|[*/^()-])")
_Scaled = tuple[float, Dimension]  # the SI value of one, and its dimension


class _Reader:
    """Reads products, quotients and powers of units. A space multiplies; operators apply from left to right."""

    def __init__(self, text: str) -> None:
        self.tokens: list[str] = []
        end = len(text.rstrip())
        at = 0
        while at < end:
            match = _TOKEN.match(text, at)
            if match is None:
                raise ValueError(text)
            self.tokens.append(match[1])
            at = match.end()
        self.tokens.append("")
        self.tokens.reverse()

    def whole(self) -> _Scaled:
        found = self.product()
        self.expect("")
        return found

    def product(self) -> _Scaled:
        factor, dimension = self.powered()
        while self.tokens[-1] not in (")", ""):
            sign = self.tokens.pop() if self.tokens[-1] in ("*", "/") else "*"
            other, of_other = self.powered()
            factor = factor / other if sign == "/" else factor * other
            dimension = dimension / of_other if sign == "/" else dimension * of_other
        return factor, dimension

    def powered(self) -> _Scaled:
        word = self.tokens.pop()
        if word == "(":
            factor, dimension = self.product()
            self.expect(")")
        else:
            factor, dimension = _named(word)
        if self.tokens[-1] in ("^", "**"):
            self.tokens.pop()
            power = self.exponent()
            factor, dimension = factor ** float(power), dimension**power
        return factor, dimension

    def exponent(self) -> Fraction:
        if self.tokens[-1] != "(":
            return self.whole_number()
        self.tokens.pop()
        power = self.whole_number()
        if self.tokens[-1] == "/":
            self.tokens.pop()
            power /= self.whole_number()
        self.expect(")")
        return power

    def whole_number(self) -> Fraction:
        sign = -1 if self.tokens[-1] == "-" else 1
        if sign < 0:
            self.tokens.pop()
        return Fraction(sign * int(self.tokens.pop()))

    def expect(self, token: str) -> None:
        if self.tokens.pop() != token:
            raise ValueError(token)


_SPELLINGS: dict[str, tuple[str, float]] = {
    spelling: (symbol, factor)
    for short, (long, factor) in (_PREFIXES | {"": ("", 1.0)}).items()
    for symbol, (name, _, _) in _DEFINITIONS.items()
    for spelling in (f"{short}{symbol}", f"{long}{name}", f"{long}{name}s")
}


def _named(word: str) -> _Scaled:
    """A unit of one word, such as kN, degree or 1.

    Raises:
        LookupError: There is no such unit.
    """
    if word == "1":
        return 1.0, Dimension()
    symbol, prefix = _SPELLINGS[word]
    _, factor, of = _DEFINITIONS[symbol]
    if of in _BASES:
        return prefix * factor, Dimension(tuple(Fraction(base == of) for base in _BASES))
    other, dimension = _Reader(of).whole()
    return prefix * factor * other, dimension


def _shortest(factor: float) -> float:
    """A factor without the rounding error of powers of ten: 1e-3 * 1000.0 is 1."""
    short = float(f"{factor:.12g}")
    return short if abs(short - factor) <= 4 * math.ulp(factor) else factor


_NUMBER = re.compile(r"\s*([-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?)\s*(.*?)\s*$")


@dataclass(frozen=True)
class Quantity:
    """A value in SI and the unit in which it was written."""

    value: float
    unit: Unit


def parse_quantity(text: str | float) -> Quantity | None:
    """Read a quantity, such as "30 deg".

    Returns:
        The quantity; None if the text does not begin with a number.

    Raises:
        UnknownUnit: The text after the number is not a unit.
    """
    if isinstance(text, int | float):
        return Quantity(float(text), parse_unit("1"))
    match = _NUMBER.match(text)
    if match is None:
        return None
    unit = parse_unit(match[2])
    return Quantity(scaled(float(match[1]), unit.factor), unit)


def scaled(number: float, factor: float) -> float:
    """number * factor, by division where that is exact: "15 ms" is 0.015 and not 0.015000000000000001."""
    inverse = 1 / factor
    return number / inverse if factor < 1 and inverse == round(inverse) else number * factor


def known_units() -> tuple[str, ...]:
    """The units that error messages suggest."""
    return _NAMES
