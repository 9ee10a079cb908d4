"""What workers find by name: pieces of work, one of which ends its worker."""

from __future__ import annotations

import os
import signal
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from distributed import Nanny


def square_unless_three(number: int) -> int:
    """3 ends its process, as a defect in a compiled library would."""
    if number == 3:
        os.kill(os.getpid(), signal.SIGKILL)
    return number * number


def status_of_nanny(dask_worker: Nanny) -> str:
    """``running`` once its worker has started; the name of the argument is Dask's."""
    return dask_worker.status.name
