"""Pieces of work that workers find by name: one of them ends its worker."""

from __future__ import annotations

import os
import signal


def square_unless_three(number: int) -> int:
    """3 ends its process, as a defect in a compiled library would."""
    if number == 3:
        os.kill(os.getpid(), signal.SIGKILL)
    return number * number
