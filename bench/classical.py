"""The classical models against closed forms and independent integrations, as a table: python bench/classical.py.

Values of rows without a closed form are fixed points that were computed apart from gaitsim, by integration with
event location at a tolerance of 1e-12 and Newton's method; the models and their parameters are the papers'.
"""

from __future__ import annotations

import math
import sys
import time
from collections.abc import Iterator, Mapping
from pathlib import Path

import gaitsim
from gaitsim.errors import GaitsimError

SPECS = Path(__file__).parents[1] / "specs"
G = 9.81
Row = tuple[str, str, float, float]  # which model, what, the value to meet, ours


def hopping(height: float) -> Iterator[Row]:
    """A drop onto a spring, in closed form (Blickhan 1989)."""
    begun = time.perf_counter()
    found = (
        gaitsim.run(
            SPECS / "hopping_spring_mass.yaml",
            {"initial.guide.z": f"{1 + height} m", "simulate.duration": "3 s"},
            save=False,
        )
        .outcomes[0]
        .metrics
    )
    omega, speed = math.sqrt(20e3 / 80), math.sqrt(2 * G * height)
    ratio = speed * omega / G
    deep = 1 + math.sqrt(1 + ratio**2)
    values = {
        "contact_time": 2 / omega * (math.pi - math.atan(ratio)),
        "lowest_height": 1 - G / omega**2 * deep,
        "peak_force": 80 * G * deep,
        "apex_height": 1 + height,
    }
    yield from rows(f"hopping, {height} m", values, found, begun)


def rows(name: str, values: Mapping[str, float], found: Mapping[str, float], begun: float) -> Iterator[Row]:
    """Rows of one gait, with the time that it took."""
    taken = time.perf_counter() - begun
    for what, value in values.items():
        yield f"{name} ({taken:.2f} s)", what, value, found[what]


def gait(name: str, spec: str, values: Mapping[str, float], **settings: str) -> Iterator[Row]:
    """Rows of a periodic gait: numbers of its start, metrics, the period and the absolute of the first eigenvalues."""
    begun = time.perf_counter()
    found = gaitsim.cycle(SPECS / f"{spec}.yaml", settings)
    numbers = {**found.metrics, **found.start, "period": found.period}
    for i, each in enumerate(found.eigenvalues):
        numbers |= {f"eigenvalue {i + 1}, real": each.real, f"eigenvalue {i + 1}, absolute": abs(each)}
    yield from rows(name, values, numbers, begun)


def running() -> Iterator[Row]:
    """Spring-mass running (Seyfarth et al. 2002)."""
    angle = "leg.touchdown_angle"
    found = {"initial_apex_height": 0.95956871, "eigenvalue 1, real": 0.44141, "contact_time": 0.15805}
    yield from gait("running, 67 deg", "running_slip", {**found, "peak_force": 2641.9}, **{angle: "67 deg"})
    found = {"initial_apex_height": 1.21435791, "eigenvalue 1, real": 1.43723}
    start = {"initial_apex_height": "1.2 m"}
    yield from gait("running, 67 deg, unstable", "running_slip", found, **{angle: "67 deg"}, **start)
    found = {"initial_apex_height": 0.94026714, "eigenvalue 1, real": -0.16131, "contact_time": 0.14924}
    yield from gait("running, 68 deg", "running_slip", {**found, "peak_force": 2086.9})
    found = {"initial_apex_height": 1.33768638, "eigenvalue 1, real": 1.68697}
    yield from gait("running, 68 deg, unstable", "running_slip", found, initial_apex_height="1.33 m")
    for start_height, following in ((0.94, 0.94031143), (0.96, 0.94126245), (1.0, 0.95574041), (1.1, 1.02715288)):
        begun = time.perf_counter()
        chosen = {"initial_apex_height": f"{start_height} m", "simulate.duration": "1 s"}
        metrics = gaitsim.run(SPECS / "running_slip.yaml", chosen, save=False).outcomes[0].metrics
        values = {"apex_height.first": following}
        yield from rows(f"return map of 68 deg, from {start_height} m", values, metrics, begun)


def walking() -> Iterator[Row]:
    """Walking on springs (Geyer, Seyfarth & Blickhan 2006)."""
    values = {
        "initial_height": 0.971160,
        "forward_velocity": 1.097909,
        "eigenvalue 1, real": 0.804951942,
        "eigenvalue 1, absolute": abs(complex(0.804951942, 0.546264486)),
        "period": 0.444024,
        "double_support": 0.166904,
        "step_length": 0.513845,
    }
    yield from gait("walking on springs", "walking_slip", values)
    values = {"initial_height": 0.967596, "initial_upward_velocity": -0.238226, "forward_velocity": 1.086492}
    start = {"initial_height": "0.9676 m", "initial_upward_velocity": "-0.238 m/s"}
    yield from gait("walking on springs, asymmetric", "walking_slip", values, **start)


def simplest() -> Iterator[Row]:
    """The simplest walker (Garcia et al. 1998)."""
    names = ("initial_half_angle", "initial_stance_rate", "period", "eigenvalue 1, real", "eigenvalue 1, absolute")
    eigenvalue = complex(-0.190099639, 0.557599274)
    for name, slope, start, numbers in (
        ("long", 0.009, None, (0.2003109005, 0.1998324730, 3.88246375, eigenvalue.real, abs(eigenvalue))),
        ("short", 0.009, (0.194, 0.204, 0.189), (0.1939373698, 0.2038669274, 3.09610587, 4.00386, 4.00386)),
        ("long", 0.015, (0.2367, 0.2315, 0.206), (0.2367121850, 0.2315461312, 3.91200394, -0.98046, 0.98046)),
    ):
        at = zip(("half_angle", "stance_rate", "swing_rate"), start or (), strict=bool(start))
        settings = {f"initial_{each}": str(value) for each, value in at}
        units = {"initial_half_angle": "rad", "initial_stance_rate": "rad/s", "initial_swing_rate": "rad/s"}
        settings = {each: f"{value} {units[each]}" for each, value in settings.items()}
        values = dict(zip(names, numbers, strict=True))
        yield from gait(
            f"simplest walker, {slope} rad, {name}", "walking_simplest", values, slope=f"{slope} rad", **settings
        )


def compass() -> Iterator[Row]:
    """The compass gait (Goswami, Thuilot & Espiau 1998)."""
    names = ("initial_half_angle", "initial_stance_rate", "initial_swing_rate", "period", "step_length", "speed")
    for slope, eigenvalue, numbers in (
        ("3 deg", 0.57995, (0.27102868, 1.09238359, 0.37737395, 0.734346, 0.535445, 0.729146)),
        ("4.3 deg", 0.90288, (0.30637365, 1.15017032, 0.16635905, 0.752301, 0.603206, 0.801815)),
    ):
        values = {**dict(zip(names, numbers, strict=True)), "eigenvalue 1, absolute": eigenvalue}
        yield from gait(f"compass gait, {slope}", "walking_compass", values, slope=slope)


def wheel(spokes: int, slope: float) -> Iterator[Row]:
    """A rimless wheel, in closed form (McGeer 1990)."""
    half = math.pi / spokes
    kept = math.cos(2 * half)
    rate = kept * math.sqrt(4 * G * math.sin(slope) * math.sin(half) / (1 - kept**2))
    values = {"initial_rate": rate, "rate_before": rate / kept, "eigenvalue 1, real": kept**2}
    yield from gait(
        f"rimless wheel, {spokes} spokes, {slope} rad",
        "rimless_wheel",
        values,
        spokes=str(spokes),
        slope=f"{slope} rad",
    )


def windows() -> None:
    """Print at which angles of touchdown running is stable, on a grid of half a degree, as a table in Markdown."""
    print("| speed at a height of 1 m | stable at touchdown angles of |\n|---|---|")
    for speed in (2.5, 3.0, 3.5, 4.0, 5.0, 6.0):
        found = [f"{half / 2:.1f}" for half in range(124, 153) if stable(speed, half / 2)]
        print(f"| {speed} m/s | {', '.join(found) or 'none'} |")


def stable(speed: float, angle: float) -> bool:
    """Whether there is a stable gait at an angle in deg, from one of three heights to start Newton's method at."""
    settings = {"leg.touchdown_angle": f"{angle} deg", "reference_speed": f"{speed} m/s"}
    for height in ("0.95 m", "0.92 m", "1 m"):
        try:
            if gaitsim.cycle(SPECS / "running_slip.yaml", {**settings, "initial_apex_height": height}).stable:
                return True
        except GaitsimError:
            continue
    return False


def main() -> None:
    """Print the tables in Markdown; with the word windows, the stable angles of running only."""
    if "windows" in sys.argv[1:]:
        windows()
        return
    print("| model (wall time) | quantity | value to meet | gaitsim | difference |\n|---|---|---|---|---|")
    tables = (hopping(0.05), hopping(0.1), running(), walking(), simplest(), compass(), wheel(8, 0.08), wheel(12, 0.04))
    for table in tables:
        for model, what, value, ours in table:
            print(f"| {model} | {what} | {value:.9g} | {ours:.9g} | {ours - value:.1e} |")


if __name__ == "__main__":
    main()
