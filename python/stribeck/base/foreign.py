"""Errors of the system and of libraries, in sentences of our own."""

from __future__ import annotations

import errno

from stribeck.base.errors import one_line

__all__ = ["sentence_of"]

#: What to do about an error of the system; without a row the system's own words suffice.
_REMEDIES = {
    errno.EMFILE: "close other programs' files, or allow more with `ulimit -n`",
    errno.ENFILE: "close other programs, then try again",
    errno.ENOSPC: "make room there, or give another path",
    errno.EACCES: "give a path that may be read and written",
    errno.EPERM: "give a path that may be read and written",
    errno.EROFS: "give a path that may be written",
    errno.ENAMETOOLONG: "give a shorter name",
    errno.ENOENT: "give a path that exists",
    errno.ELOOP: "the links lead in a circle, give another path",
}


def sentence_of(error: BaseException) -> str | None:
    """The sentence for an error that an input or the system caused; None for a defect of ours.

    Examples
    --------
    >>> sentence_of(MemoryError())
    'memory ran out: give less data, fewer starts or a coarser grid, or close other programs'
    >>> sentence_of(OSError(24, "Too many open files"))
    "Too many open files: close other programs' files, or allow more with `ulimit -n`"
    >>> sentence_of(KeyError("x")) is None
    True
    """
    if isinstance(error, MemoryError):
        return (
            "memory ran out: give less data, fewer starts or a coarser grid, or close other "
            "programs"
        )
    if isinstance(error, RecursionError):
        return "the input is nested too deeply: give one with fewer levels"
    if isinstance(error, OverflowError | FloatingPointError):
        return (
            f"a number is too large to compute with ({one_line(str(error), 120)}): check the "
            f"values and their units"
        )
    if isinstance(error, OSError):
        return one_line(_of_the_system(error))
    if isinstance(error, ValueError) and "embedded null" in str(error):
        return "a name has a null character: give one without"
    if type(error).__module__.startswith("stribeck._core"):
        return one_line(str(error))
    return None


def _of_the_system(error: OSError) -> str:
    where = f"{error.filename}: " if error.filename else ""
    remedy = _REMEDIES.get(error.errno or 0)
    return f"{where}{error.strerror or error}{f': {remedy}' if remedy else ''}"
