"""The measures of walking on hand-made steps with known answers."""

from __future__ import annotations

import math

import numpy as np
import pytest
from components.calls import Tables, metrics, primitive

NAN = pytest.approx(math.nan, nan_ok=True)
DT = 0.01


def walking(times: np.ndarray, stride: float, stance: float, late: float = 0.0) -> np.ndarray:
    """1 while a leg stands: for a share `stance` of each stride; touchdowns at late, late + stride ..."""
    return (np.mod(times - late + 1e-9, stride) < stance * stride - 1e-9).astype(float)


def steps(seconds: float, dt: float = DT) -> np.ndarray:
    return np.arange(round(seconds / dt)) * dt


def test_stance_passes_over_scuffs_and_bounces() -> None:
    # Stance 0.6 s, swing 0.4 s; a bounce of 10 ms after touchdown, a scuff of 10 ms in mid-swing.
    load = np.array(([1.0] * 20 + [0.0] + [0.8] * 39 + [0.0] * 20 + [0.3] + [0.0] * 19) * 5)
    found = metrics("measure/stance", {"load": load}, DT)
    assert found == pytest.approx({"value": 3, "stride_time": 1.0})  # it stood at the start: four touchdowns
    without = metrics("measure/stance", {"load": load}, DT, hold=0.0)
    assert without["value"] == 13  # every bounce and every scuff is a touchdown


def test_stance_is_late_by_its_hold_and_says_so() -> None:
    tables = Tables(primitive("measure/stance")).put({"hold": 0.03, "load": 0.0})
    tables.call("start", "rapid")
    seen = []
    for load in [0.0] * 5 + [1.0] * 10 + [0.05] * 10:
        tables.put({"load": load}).call("output", "rapid")
        seen.append((tables.y.in_stance, round(tables.y.delay, 9)))
        tables.call("update", "rapid", DT)
    assert [stance for stance, _ in seen] == [0.0] * 8 + [1.0] * 10 + [0.0] * 7
    assert seen[8] == (1.0, 0.03)


def test_stance_fraction() -> None:
    times = steps(10)
    left, right = walking(times, 1.0, 0.62), walking(times, 1.0, 0.6, late=0.5)
    found = metrics("measure/stance_fraction", {"left": left, "right": right}, DT)
    # Both stand for 0.12 s after the right touchdown and for 0.10 s after the left one.
    assert found == pytest.approx(
        {"value": 0.61, "left_fraction": 0.62, "right_fraction": 0.6, "double_support": 0.22, "flight": 0}
    )


def test_stance_fraction_of_running_and_of_one_leg() -> None:
    times = steps(10)
    left, right = walking(times, 0.8, 0.35), walking(times, 0.8, 0.35, late=0.4)
    found = metrics("measure/stance_fraction", {"left": left, "right": right}, DT)
    assert found == pytest.approx(
        {"value": 0.35, "left_fraction": 0.35, "right_fraction": 0.35, "double_support": 0, "flight": 0.3}
    )
    alone = metrics("measure/stance_fraction", {"left": left}, DT)
    assert alone["value"] == alone["left_fraction"] == pytest.approx(0.35)
    assert alone["right_fraction"] == NAN


def test_strides_before_settling_do_not_count() -> None:
    times = steps(10)
    left = np.where(times < 3, walking(times, 1.0, 0.9), walking(times, 1.0, 0.6))
    assert metrics("measure/stance_fraction", {"left": left}, DT, settle=3.0)["value"] == pytest.approx(0.6)
    assert metrics("measure/stance_fraction", {"left": left}, DT, settle=0.0)["value"] == pytest.approx(
        (0.9 * 2 + 0.6 * 6) / 8  # the stride that was cut by the start is not one of them
    )
    assert metrics("measure/stance_fraction", {"left": left}, DT, settle=20.0)["value"] == NAN


def test_step_length() -> None:
    # At every touchdown the right foot lands 0.7 m ahead of the left, and the left 0.6 m ahead of the right.
    times = steps(10)
    left, right = walking(times, 1.0, 0.6), walking(times, 1.0, 0.6, late=0.5)
    signals = {
        "left": left,
        "right": right,
        "left_position": 1.3 * np.floor(times + 1e-9),
        "right_position": 1.3 * np.floor(times + 0.5 + 1e-9) - 0.6,
    }
    found = metrics("measure/step_length", signals, DT)
    assert found == pytest.approx(
        {
            "value": 0.65,
            "left_length": 0.6,
            "right_length": 0.7,
            "stride_length": 1.3,
            "asymmetry": 0.1 / 0.65,
        }
    )
    # A foot that rolls on, 5 cm after it was set down, has left its print where it was.
    rolling = signals | {"left_position": signals["left_position"] + 0.05 * ((times + 1e-9) % 1 > 0.1)}
    assert metrics("measure/step_length", rolling, DT) == pytest.approx(found)
    assert metrics("measure/step_length", signals, DT, settle=50.0)["value"] == NAN


def test_cadence() -> None:
    times = steps(10)
    signals = {"left": walking(times, 1.1, 0.6), "right": walking(times, 1.1, 0.6, late=0.55)}
    found = metrics("measure/cadence", signals, DT, settle=0.0)
    assert found["step_time"] == pytest.approx(0.55)
    assert found["value"] * 60 == pytest.approx(60 / 0.55)  # in SI here; reported in 1/min
    assert primitive("measure/cadence").metrics["value"].unit == "1/min"
    # Touchdowns at 0.55, 1.10 ... 9.90 s; the one at 0 s was before the first step.
    assert found["touchdown_count"] == 18
    assert metrics("measure/cadence", signals, DT, settle=9.6)["value"] == NAN


def test_speed() -> None:
    # 2 m/s for two seconds, then 1.25 m/s, and back a little in between.
    times = steps(10)
    position = 5 + np.where(times <= 2, 2 * times, 4 + 1.25 * (times - 2) + 0.3 * np.sin(np.pi * (times - 2)))
    found = metrics("measure/speed", {"position": position}, DT)
    lasted = times[-1] - 2
    end = 1.25 * lasted + 0.3 * math.sin(math.pi * lasted)
    assert found == pytest.approx({"value": end / lasted, "distance": 4 + end})
    short = metrics("measure/speed", {"position": position[:100]}, DT)
    assert short == {"value": NAN, "distance": pytest.approx(2 * 0.99)}


def test_swing_angle() -> None:
    times = steps(6)
    stance = walking(times, 1.0, 0.6)
    # 60, 61 ... deg in swing, and 80 deg in stance, which is not asked for.
    angle = np.radians(np.where(stance > 0.5, 80.0, 60.0 + np.floor(times) - 30 * np.abs(np.mod(times, 1) - 0.8)))
    found = metrics("measure/swing_angle", {"angle": angle, "stance": stance}, DT)
    # Swings that began at 2.6, 3.6 and 4.6 s; the last is not over, and the first two were too early.
    assert found["swings"] == 3
    assert math.degrees(found["value"]) == pytest.approx(63, abs=1e-9)
    assert math.degrees(found["largest"]) == pytest.approx(64, abs=1e-9)
    # An angle that falls with flexion, with 180 deg for a straight knee.
    other = metrics(
        "measure/swing_angle", {"angle": math.pi - angle, "stance": stance}, DT, direction=-1.0, zero=math.pi
    )
    assert other == pytest.approx(found)


@pytest.mark.parametrize("dt", [0.01, 0.001])  # at 1 ms a stance has more steps than there is room for
def test_force_peaks(dt: float) -> None:
    times = steps(8, dt)
    phase = np.mod(times + 1e-9, 1.0) / 0.6
    # 1.1 at a quarter, 0.8 at the half, 1.2 at three quarters, and an impact within the first 10 ms.
    load = np.interp(phase, [0, 0.25, 0.5, 0.75, 1, 1.0001], [0.1, 1.1, 0.8, 1.2, 0.1, 0])
    stance = metrics_of_stance(load, dt)
    found = metrics("measure/force_peaks", {"load": load, "stance": stance}, dt)
    assert found["first"] == pytest.approx(1.1, abs=0.02)
    assert found["second"] == pytest.approx(1.2, abs=0.02)
    assert found["value"] == pytest.approx(1.2, abs=0.02)
    assert found["trough"] == pytest.approx(0.8, abs=0.02)
    assert found["two_peaks"] == 1
    strike = np.where(np.mod(times + 1e-9, 1.0) < 0.0101, 2.2, load)
    struck = metrics("measure/force_peaks", {"load": strike, "stance": stance}, dt)
    assert struck["first"] == pytest.approx(2.2)


def metrics_of_stance(load: np.ndarray, dt: float) -> list[float]:
    """in_stance as measure/stance tells it, 20 ms late."""
    tables = Tables(primitive("measure/stance")).put({"load": load[0]})
    tables.call("start", "rapid")
    seen = []
    for value in load:
        tables.put({"load": value}).call("output", "rapid")
        seen.append(float(tables.y.in_stance))
        tables.call("update", "rapid", dt)
    return seen


def test_one_hump_is_not_two_peaks() -> None:
    times = steps(8)
    phase = np.mod(times + 1e-9, 1.0) / 0.6
    load = np.where(phase < 1, 1.5 * np.sin(np.pi * np.minimum(phase, 1)), 0)
    found = metrics("measure/force_peaks", {"load": load, "stance": metrics_of_stance(load, DT)}, DT)
    assert found["two_peaks"] == 0
    assert found["value"] == pytest.approx(1.5, abs=0.01)


def test_load_limit() -> None:
    # Every second, 0.1 s of 1.5 body weights on the left foot and 0.2 s of 1.4 on the right.
    times = steps(11)
    left = np.where(np.mod(times + 1e-9, 1) < 0.1, 1.5, 1.0)
    right = np.where(np.mod(times + 1e-9, 1) > 0.8, 1.4, 0.0)
    left[0] = 9.0  # before it counts
    found = metrics("measure/load_limit", {"left": left, "right": right}, DT, limit=1.3)
    assert found == pytest.approx({"value": 0.1 * 0.2 + 0.2 * 0.1, "peak": 1.5, "share": 0.3})
    assert metrics("measure/load_limit", {"left": left}, DT, limit=1.6)["value"] == 0


def test_limit_torque() -> None:
    torque = [50.0] * 100 + [0.0] * 60 + [-20.0] * 30 + [10.0] * 10
    found = metrics("measure/limit_torque", {"torque": torque}, DT)
    assert found == pytest.approx({"value": (20 * 30 + 10 * 10) / 100, "peak": 20})
    tables = Tables(primitive("measure/limit_torque")).put({"torque": -20.0})
    tables.call("output", "rapid")
    assert tables.y.magnitude == 20


def test_effort() -> None:
    signal = [0.5] * 100 + [0.2] * 100
    squared = metrics("measure/effort", {"signal": signal}, DT)
    assert squared == pytest.approx({"value": 0.25 + 0.04, "mean": 0.145})
    cubed = metrics("measure/effort", {"signal": signal}, DT, exponent=3.0, weight=2.0)
    assert cubed["value"] == pytest.approx(2 * (0.125 + 0.008))


def test_total() -> None:
    found = metrics("measure/total", {"signal": [-4.0, -2.0, -3.0]}, DT)
    assert found == {"value": -3, "peak": -2}
    assert metrics("measure/total", {"signal": [9.0, 1.0, 3.0]}, 1.0, settle=1.0) == {"value": 2, "peak": 3}


def test_symmetry() -> None:
    left, right = [1.0, -3.0] * 300, [1.0, -1.0] * 300
    found = metrics("measure/symmetry", {"left": left, "right": right}, DT)
    assert found == pytest.approx({"value": 2 * (2 - 1) / (2 + 1), "left_mean": 2, "right_mean": 1})
    assert metrics("measure/symmetry", {"left": left, "right": left}, DT)["value"] == 0
    assert metrics("measure/symmetry", {"left": left, "right": [0.0] * 600}, DT)["value"] == 2


def test_fall_tells_a_fall_from_a_run_that_ended() -> None:
    upright = metrics("measure/fall", {"height": [1.0] * 40}, DT, below=0.5)
    assert upright == pytest.approx({"value": 0.4, "fell": 0})
    fallen = metrics("measure/fall", {"height": [1.0] * 30 + [0.49] * 2}, DT, below=0.5)
    assert fallen == pytest.approx({"value": 0.3, "fell": 1})
    leaning = {"height": [1.0] * 40, "lean": [0.1] * 20 + [-0.9] * 20}
    assert metrics("measure/fall", leaning, DT, below=0.5)["fell"] == 0
    found = metrics("measure/fall", leaning, DT, below=0.5, beyond=0.8)
    assert found == pytest.approx({"value": 0.2, "fell": 1})


def test_the_speed_of_each_stride_and_its_error() -> None:
    times = steps(20)
    speed = np.where(times < 10, 1.0, 1.4)
    asked = np.where(times < 10, 1.1, 1.4)
    signals = {"position": np.cumsum(speed) * DT - speed * DT, "asked": asked, "stance": walking(times, 1.0, 0.6, 0.5)}
    found = metrics("measure/stride_speed", signals, DT, settle=2.0)
    # Strides begin at 2.5 s, 3.5 s ... and 18.5 s; one of the 17 is half slow and half fast.
    strides = np.array([1.0] * 7 + [1.2] + [1.4] * 9)
    errors = np.array([0.1] * 7 + [0.05] + [0.0] * 9)
    assert found["value"] == pytest.approx(np.mean(strides), rel=1e-9)
    assert found["error"] == pytest.approx(math.sqrt(np.mean(errors**2)), rel=1e-9)
    assert (found["slowest"], found["fastest"]) == pytest.approx((1.0, 1.4))
    assert found["largest_error"] == pytest.approx(0.1)


def test_no_stride_has_no_speed() -> None:
    times = steps(1)
    signals = {"position": times, "asked": times, "stance": np.zeros(len(times))}
    assert metrics("measure/stride_speed", signals, DT) == dict.fromkeys(
        ("value", "error", "largest_error", "slowest", "fastest"), NAN
    )
