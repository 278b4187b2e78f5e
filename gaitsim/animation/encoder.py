"""Video files: MP4 for browsers, or GIF. Frames are encoded one by one."""

from __future__ import annotations

import contextlib
import subprocess
import tempfile
from pathlib import Path
from types import TracebackType
from typing import IO, Any

import numpy as np
from numpy.typing import NDArray

from gaitsim.animation.errors import CannotAnimate

Pixels = NDArray[np.uint8]
_COLOURS = 256


class Encoder:
    """Writes frames to a file that is complete or absent.

    Args:
        path: The file.
        rate: Frames per second.
        size: Width and height in pixels.
        sample: For a GIF, pixels with all colours of the film.
    """

    def __init__(self, path: Path, rate: float, size: tuple[int, int], sample: Pixels | None = None) -> None:
        self.path, self.rate, self.size = path, rate, size
        self._sample = sample
        self._draft = path.with_name(f"{path.stem}.partial{path.suffix}")
        self._process: Any = None
        self._messages: IO[bytes] | None = None
        self._palette: Path | None = None

    def __enter__(self) -> Encoder:
        """Start ffmpeg.

        Raises:
            CannotAnimate: The model cannot be drawn.
        """
        try:
            self.path.parent.mkdir(parents=True, exist_ok=True)
            self._messages = tempfile.TemporaryFile()
            command = [_program(), "-y", "-loglevel", "error", *self._input(), *self._output(), str(self._draft)]
            self._process = subprocess.Popen(
                command, stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, stderr=self._messages
            )
        except OSError as error:
            raise CannotAnimate(f"{self.path}: the video cannot be written: {error.strerror}.") from error
        return self

    def add(self, frame: Pixels) -> None:
        """Add a frame, an array of height x width x 3."""
        try:
            self._process.stdin.write(np.ascontiguousarray(frame).data)
        except OSError as error:
            raise CannotAnimate(self._reason()) from error

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """End ffmpeg, and remove what is not complete.

        Raises:
            CannotAnimate: The model cannot be drawn.
        """
        try:
            with contextlib.suppress(OSError):
                self._process.stdin.close()
            if kind is not None:
                self._process.kill()
            if self._process.wait() != 0 and kind is None:
                raise CannotAnimate(self._reason())
            if kind is None:
                self._draft.replace(self.path)
        finally:
            self._draft.unlink(missing_ok=True)
            if self._palette is not None:
                self._palette.unlink(missing_ok=True)
            if self._messages is not None:
                self._messages.close()

    def _reason(self) -> str:
        self._process.wait()
        assert self._messages is not None
        self._messages.seek(0)
        lines = self._messages.read().decode(errors="replace").strip().splitlines()
        message = next(
            (line for line in lines if "No space left" in line), lines[-1] if lines else "ffmpeg ended early"
        )
        return f"{self.path}: the video cannot be written: {message.rpartition(': ')[2].rstrip('.')}."

    def _input(self) -> list[str]:
        size = f"{self.size[0]}x{self.size[1]}"
        return ["-f", "rawvideo", "-pix_fmt", "rgb24", "-s", size, "-r", f"{self.rate:g}", "-i", "-"]

    def _output(self) -> list[str]:
        if self.path.suffix.lower() == ".gif":
            use = "[0:v][1:v]paletteuse=dither=none:diff_mode=rectangle"
            return ["-i", str(self._written_palette()), "-filter_complex", use, "-loop", "0"]
        look = ["-preset", "veryfast", "-crf", "21", "-pix_fmt", "yuv420p"]
        return ["-c:v", "libx264", *look, "-movflags", "+faststart", "-an"]

    def _written_palette(self) -> Path:
        """A picture of 256 colours that represent the sample, for ffmpeg: 16 x 16 pixels."""
        from PIL import Image

        assert self._sample is not None
        with tempfile.NamedTemporaryFile(suffix=".png", delete=False) as file:
            self._palette = Path(file.name)
        few = Image.fromarray(self._sample).quantize(_COLOURS).convert("RGB").getcolors(_COLOURS)
        colours = np.array([colour for _, colour in few or []], dtype=np.uint8)
        Image.fromarray(np.resize(colours, (16, 16, 3))).save(self._palette)
        return self._palette


def _program() -> str:
    import imageio_ffmpeg

    try:
        return str(imageio_ffmpeg.get_ffmpeg_exe())
    except RuntimeError as error:
        move = "install ffmpeg (apt install ffmpeg), or name it in IMAGEIO_FFMPEG_EXE"
        raise CannotAnimate(f"no video: there is no ffmpeg for this machine; {move}.") from error
