"""What holds for all tests."""

from __future__ import annotations

import signal

# Where a shell starts tests in the background, Ctrl-C is ignored, also by what they start: tests send it.
signal.signal(signal.SIGINT, signal.default_int_handler)
