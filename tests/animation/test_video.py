"""Video files, decoded again: length, size, format, and that something moves."""

from __future__ import annotations

import re
import subprocess
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import imageio_ffmpeg
import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

from gaitsim.analysis.replays.replay import Replay
from gaitsim.animation import CannotAnimate
from gaitsim.animation.caption import Caption
from gaitsim.animation.video import VideoOptions, _ending, read_size, record
from gaitsim.errors import GaitsimError, Usage
from tests.analysis.replays import cut, of_spec
from tests.animation.runs import run_of

SIZE = (640, 360)


@pytest.fixture(scope="module")
def hopper() -> Replay:
    return run_of("hopping_geyer2003")


def decoded(path: Path) -> tuple[dict[str, Any], list[NDArray[np.uint8]]]:
    """What the file says of itself, and its frames."""
    reader = imageio_ffmpeg.read_frames(str(path))
    about = next(reader)
    width, height = about["size"]
    return about, [np.frombuffer(frame, np.uint8).reshape(height, width, 3) for frame in reader]


def differ(first: NDArray[np.uint8], second: NDArray[np.uint8]) -> int:
    """How many pixels are clearly not the same."""
    return int((np.abs(first.astype(int) - second.astype(int)).sum(axis=2) > 60).sum())


def test_an_mp4_plays_in_browsers_and_moves(hopper: Replay, tmp_path: Path) -> None:
    told: list[tuple[int, int]] = []
    path = record(hopper, tmp_path / "new" / "hop.mp4", VideoOptions(size=SIZE), lambda *done: told.append(done))
    about, frames = decoded(path)
    assert about["size"] == SIZE and about["fps"] == 30
    assert about["codec"] == "h264" and about["pix_fmt"].startswith("yuv420p")
    assert len(frames) == 30
    assert about["duration"] == pytest.approx(1.0, abs=0.01)
    assert told == [(k + 1, 30) for k in range(30)]
    picture = slice(0, 268)
    assert differ(frames[0][:, picture], frames[8][:, picture]) > 1000
    assert differ(frames[0][:, 268:], frames[8][:, 268:]) > 300
    # The index comes first, so that a browser can begin before it has the whole file.
    data = path.read_bytes()
    assert data.index(b"moov") < data.index(b"mdat")
    assert [file.name for file in path.parent.iterdir()] == ["hop.mp4"]


def test_a_gif_has_the_same_motion(hopper: Replay, tmp_path: Path) -> None:
    path = record(hopper, tmp_path / "hop.gif", VideoOptions(size=(480, 270), end=0.5))
    with Image.open(path) as image:
        assert image.size == (480, 270)
        assert image.n_frames == 11
        assert image.info["loop"] == 0
        frames, lengths = [], []
        for k in range(11):
            image.seek(k)
            lengths.append(image.info["duration"])
            frames.append(np.asarray(image.convert("RGB")))
    assert lengths == [50] * 11
    assert differ(frames[0][:, :200], frames[5][:, :200]) > 500


@pytest.mark.parametrize(
    ("options", "frames", "rate"),
    [
        (VideoOptions(size=SIZE, speed=0.25, end=0.2, rate=20), 17, 20),
        (VideoOptions(size=(301, 421), speed=2, rate=10), 5, 10),
        (VideoOptions(size=SIZE, begin=0.4, end=0.5, rate=50, scopes=["leg.*force"]), 6, 50),
    ],
    ids=["slow", "fast and upright", "a stretch"],
)
def test_speed_rate_size_and_stretch(
    hopper: Replay, tmp_path: Path, options: VideoOptions, frames: int, rate: float
) -> None:
    about, decoded_frames = decoded(record(hopper, tmp_path / "hop.mp4", options))
    assert len(decoded_frames) == frames
    assert about["fps"] == rate
    assert options.size is not None
    assert about["size"] == tuple(2 * (side // 2) for side in options.size)


def test_a_run_of_one_instant_is_one_frame(hopper: Replay, tmp_path: Path) -> None:
    _, frames = decoded(record(cut(hopper, 1), tmp_path / "hop.mp4", VideoOptions(size=SIZE)))
    assert len(frames) == 1


def test_a_run_without_an_instant_is_refused(hopper: Replay, tmp_path: Path) -> None:
    with pytest.raises(CannotAnimate, match="no motion was recorded, so there is no video"):
        record(cut(hopper, 0), tmp_path / "hop.mp4")


@pytest.mark.parametrize(
    ("name", "options", "words"),
    [
        ("hop.avi", VideoOptions(), "hop.avi: a video ends in .mp4 or .gif."),
        ("hop.mp4", VideoOptions(speed=0), "--speed 0: seconds of motion in a second of video, above 0, such as 0.25."),
        ("hop.mp4", VideoOptions(view="above"), "--view above: one of side, behind, oblique."),
        ("hop.mp4", VideoOptions(rate=0), "--fps 0: frames in a second, from 1 to 240."),
        ("hop.mp4", VideoOptions(size=(90, 900)), "--size 90x900: width x height in pixels, each from 200 to 4096."),
        ("hop.mp4", VideoOptions(begin=3), "there is no motion from 3 s to 0.9999 s; it goes from 0 s to 0.9999 s."),
        ("hop.mp4", VideoOptions(scopes=["*"], size=SIZE), " signals match, and this size has room for 8; narrow it."),
    ],
    ids=["ending", "speed", "view", "rate", "size", "stretch", "scopes"],
)
def test_what_cannot_be_made_is_said(
    hopper: Replay, tmp_path: Path, name: str, options: VideoOptions, words: str
) -> None:
    with pytest.raises(Usage) as raised:
        record(hopper, tmp_path / name, options)
    assert str(raised.value).endswith(words)
    assert list(tmp_path.iterdir()) == []


def refusal(replay: Replay, path: Path, options: Sequence[str] = ()) -> str:
    with pytest.raises(GaitsimError) as raised:
        record(replay, path, VideoOptions(size=SIZE, end=0.3))
    return str(raised.value)


def test_no_file_stays_behind_if_ffmpeg_ends_early(
    hopper: Replay, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    full = tmp_path / "ffmpeg"
    full.write_text("#!/bin/sh\necho 'Error writing trailer: No space left on device' >&2\nexit 1\n")
    full.chmod(0o755)
    monkeypatch.setenv("IMAGEIO_FFMPEG_EXE", str(full))
    target = tmp_path / "out" / "hop.mp4"
    assert refusal(hopper, target) == f"{target}: the video cannot be written: No space left on device."
    assert list(target.parent.iterdir()) == []


def test_a_folder_that_is_a_file_is_named(hopper: Replay, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    target = tmp_path / "file" / "hop.mp4"
    assert re.fullmatch(rf"{target}: the video cannot be written: .+\.", refusal(hopper, target))


def test_frames_are_checked_by_ffmpeg_itself(hopper: Replay, tmp_path: Path) -> None:
    path = record(hopper, tmp_path / "hop.mp4", VideoOptions(size=SIZE, end=0.2))
    program = imageio_ffmpeg.get_ffmpeg_exe()
    checked = subprocess.run([program, "-v", "error", "-i", path, "-f", "null", "-"], capture_output=True, text=True)
    assert (checked.returncode, checked.stderr) == (0, "")


def test_a_size_is_two_numbers() -> None:
    assert read_size("1280x720") == (1280, 720)
    for text in ("1280", "x", "12.5x3", "axb"):
        with pytest.raises(Usage, match=f"--size {text}: width x height in pixels, such as 1280x720."):
            read_size(text)


def test_the_end_of_a_film_says_how_the_walker_fell() -> None:
    leaning = [("initial.root.roll", "-0.3 rad"), ("simulate.duration", "0.5 s")]
    replay = of_spec("walking_scone_h1922", leaning)
    assert _ending(replay, 0.1) == ("fell to the left", pytest.approx(replay.times[-1] - 0.1))
    assert _ending(replay.between(0, 0.1), 0.1) == ("", 0)
    plain = Caption("walker", 1.0, 400, 300, False, None, 100.0)
    picture = np.zeros((300, 400, 3), dtype=np.uint8)
    with_words = replace(plain, ending=("fell to the right", 2.0))
    assert np.array_equal(with_words.put_on(picture, 1.9), plain.put_on(picture, 1.9))
    changed = np.flatnonzero((with_words.put_on(picture, 2.0) != plain.put_on(picture, 2.0)).any(axis=(0, 2)))
    assert changed.min() > 200 and changed.max() < 400  # at the right
