"""What the command needs from the process that starts it."""

from __future__ import annotations

import os
import re

from stribeck.base.errors import StribeckError
from stribeck.base.foreign import sentence_of

#: Variables that hold a number of threads; libraries complain of others in words of their own.
THREADS = (
    "OMP_NUM_THREADS",
    "OPENBLAS_NUM_THREADS",
    "MKL_NUM_THREADS",
    "POLARS_MAX_THREADS",
    "RAYON_NUM_THREADS",
)
#: Files that must be free to be opened: libraries abort in their own words without them.
SPARE_FILES = 24
#: A number for each level of nesting, as OpenMP has it.
_COUNTS = re.compile(r"\s*0*[1-9]\d{0,4}(\s*,\s*0*[1-9]\d{0,4})*\s*")


def check_surroundings() -> None:
    """Refuse a folder that is gone and numbers of threads that are none.

    Raises
    ------
    StribeckError
        The working folder was removed, no more files can be opened, or a variable is no number.
    """
    try:
        os.getcwd()
    except OSError:
        raise StribeckError("the working folder is gone: change to a folder that exists") from None
    _check_files()
    for name in THREADS:
        said = os.environ.get(name, "")
        if said and not _COUNTS.fullmatch(said):
            raise StribeckError(
                f"the variable {name} is {said!r}: set a whole number from 1 on, or unset it"
            )
    # Linear algebra runs on one thread, and this way its libraries start no others.
    os.environ["OPENBLAS_NUM_THREADS"] = "1"
    # Figures go to files, so the windows that the user's backend would open play no part.
    os.environ["MPLBACKEND"] = "agg"


def _check_files() -> None:
    opened: list[int] = []
    try:
        for _ in range(SPARE_FILES):
            opened.append(os.open(os.devnull, os.O_RDONLY))
    except OSError as error:
        raise StribeckError(sentence_of(error) or str(error)) from None
    finally:
        for handle in opened:
            os.close(handle)
