"""A cache of computed bytes in the user's cache folder. An entry is complete and undamaged, or absent.

An entry is one file: the SHA-256 digest of its data, then the data. A cache that cannot be read or written stops
nothing: the data is computed again, and one warning per process says so.
"""

from __future__ import annotations

import hashlib
import logging
import os
import tempfile
from functools import cache
from pathlib import Path

from gaitsim.folders import cache_folder
from gaitsim.whole import PARTIAL, whole

_DIGEST_SIZE = hashlib.sha256().digest_size
_REMEDY = "so nothing is kept and each run compiles again; set GAITSIM_CACHE to a folder that can be written"


def cached(kind: str, key: str) -> bytes | None:
    """Read an entry of the cache.

    Args:
        kind: The folder of the entry, such as "audited".
        key: The name of the entry.

    Returns:
        The data; None if the entry is absent or damaged.
    """
    path = _path(kind, key)
    if path is None:
        return None
    try:
        whole = path.read_bytes()
    except (FileNotFoundError, NotADirectoryError):
        return None  # writing reports whether the folder can be used
    except OSError as error:
        _tell_unusable(error)
        return None
    data = whole[_DIGEST_SIZE:]
    if hashlib.sha256(data).digest() != whole[:_DIGEST_SIZE]:
        tell_once(f"{path} is damaged; it is made again.")
        return None
    return data


def keep(kind: str, key: str, data: bytes) -> None:
    """Write an entry of the cache completely, and replace an older one.

    Args:
        kind: The folder of the entry.
        key: The name of the entry.
        data: What to store.
    """
    path = _path(kind, key)
    if path is None:
        tell_once(f"there is no absolute path to a cache folder, {_REMEDY}.")
        return
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        descriptor, draft = tempfile.mkstemp(dir=path.parent, prefix=f"{key}{PARTIAL}.")
        with whole(path, Path(draft)), os.fdopen(descriptor, "wb") as file:
            file.write(hashlib.sha256(data).digest() + data)
    except OSError as error:
        _tell_unusable(error)


def tell_once(message: str) -> None:
    """Log one warning about the cache; later calls in the same process do nothing.

    Args:
        message: What the cache cannot do.
    """
    if not _warnings():
        _warnings().append(message)
        logging.getLogger("gaitsim").warning("gaitsim: %s", message)


@cache
def _warnings() -> list[str]:
    """The warnings that this process has logged."""
    return []


def _path(kind: str, key: str) -> Path | None:
    folder = cache_folder()
    return folder / kind / key if folder else None


def _tell_unusable(error: OSError) -> None:
    tell_once(f"the cache {cache_folder()} cannot be used ({error.strerror or error}), {_REMEDY}.")
