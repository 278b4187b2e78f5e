"""OpenGL without a window: EGL or OSMesa, whichever is installed, or what MUJOCO_GL names."""

from __future__ import annotations

import ctypes
import importlib
import os
import sys
from collections.abc import Mapping
from types import TracebackType
from typing import Any

import mujoco

from gaitsim.animation.errors import NoOpenGL

_LIBRARIES: Mapping[str, tuple[str, ...]] = {
    "egl": ("libEGL.so.1", "libEGL.so"),
    "osmesa": ("libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"),
}
_PACKAGES: Mapping[str, str] = {"egl": "libegl1", "osmesa": "libosmesa6"}
_ORDER: Mapping[str, tuple[str, ...]] = {"linux": ("egl", "osmesa", "glfw"), "darwin": ("cgl", "glfw")}
_OFF = ("disable", "disabled", "off", "false", "0")
_ANY = ("", "enable", "enabled", "on", "true", "1")
_NO_DEVICES = 0


def backend() -> str:
    """The OpenGL that draws: egl, osmesa, glfw or cgl.

    Raises:
        NoOpenGL: Naming the system's package that is missing.
    """
    known = _ORDER.get(sys.platform, ("glfw",))
    wanted = os.environ.get("MUJOCO_GL", "").lower().strip()
    if wanted in _OFF:
        raise NoOpenGL(f"no video: MUJOCO_GL={wanted} switches OpenGL off; unset it.")
    if wanted in ("glx", "wgl"):
        wanted = "glfw"
    if wanted not in (*known, *_ANY):
        raise NoOpenGL(f"no video: MUJOCO_GL={wanted} is no OpenGL; unset it, or write {' or '.join(known)}.")
    found = next((name for name in ((wanted,) if wanted in known else known) if _is_there(name)), None)
    if found is None:
        raise NoOpenGL(_missing(wanted))
    return found


def _missing(wanted: str) -> str:
    if wanted == "glfw":
        return "no video: MUJOCO_GL=glfw needs a display; unset it, or write egl or osmesa."
    if wanted in _PACKAGES:
        package = _PACKAGES[wanted]
        return f"no video: MUJOCO_GL={wanted} needs the system package {package} (apt install {package})."
    return "no video: OpenGL is missing; install the system package libegl1 or libosmesa6 (apt install libosmesa6)."


def _is_there(name: str) -> bool:
    if name == "glfw":
        return sys.platform != "linux" or has_display()
    if name == "cgl":
        return True
    library = next((found for found in map(_library, _LIBRARIES[name]) if found is not None), None)
    return library is not None and (name != "egl" or _devices(library) > _NO_DEVICES)


def _library(name: str) -> Any:
    try:
        return ctypes.CDLL(name)
    except OSError:
        return None


def _devices(library: Any) -> int:
    """The number of devices on which EGL can draw; 0 without a driver."""
    try:
        library.eglGetProcAddress.restype = ctypes.c_void_p
        address = library.eglGetProcAddress(b"eglQueryDevicesEXT")
    except AttributeError:
        return _NO_DEVICES
    if not address:
        return _NO_DEVICES
    count = ctypes.c_int(0)
    query = ctypes.CFUNCTYPE(ctypes.c_uint, ctypes.c_int, ctypes.c_void_p, ctypes.POINTER(ctypes.c_int))(address)
    return count.value if query(0, None, ctypes.byref(count)) else _NO_DEVICES


def has_display() -> bool:
    """Whether a window can be opened."""
    return sys.platform != "linux" or bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))


class OpenGL:
    """A context for drawing during a block. Sizes are in pixels."""

    def __init__(self, width: int, height: int) -> None:
        self._name, self._size = backend(), (width, height)
        self._context: Any = None

    def __enter__(self) -> OpenGL:
        """Make the OpenGL context current.

        Raises:
            NoOpenGL: The library is there and yet does not work.
        """
        try:
            self._context = importlib.import_module(f"mujoco.{self._name}").GLContext(*self._size)
            self._context.make_current()
        except Exception as error:
            reason = " ".join(str(error).split()) or type(error).__name__
            move = "try MUJOCO_GL=osmesa with the system package libosmesa6"
            raise NoOpenGL(f"no video: OpenGL ({self._name}) does not start ({reason}); {move}.") from error
        return self

    def painter(self, model: Any) -> Any:
        """MuJoCo's drawing context for a model, which draws into memory."""
        painter = mujoco.MjrContext(model, mujoco.mjtFontScale.mjFONTSCALE_100.value)
        mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN.value, painter)
        return painter

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._context.free()
