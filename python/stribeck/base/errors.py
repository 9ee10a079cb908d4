"""Exceptions that carry one plain sentence: what is wrong, where, and what to do.

A sentence that names an option writes it with `option`, as a Python user gives it: a keyword
argument. The command line spells the same options as flags (`spell_options`)::

    raise RecordingError(f"{path}: no time column: say which with {option('map', 'time=COLUMN')}")

    Python:        ... no time column: say which with `map="time=COLUMN"`
    command line:  ... no time column: say which with --map time=COLUMN

Several values are a list in Python and a flag each on the command line. Without a value,
``f"use {option('where')}"`` gives "use option `where`", or "use --where". Write the name with
underscores, as in Python, and no article before it.
"""

from __future__ import annotations

import difflib
import re
from collections.abc import Callable, Iterable

__all__ = [
    "MOST_CHARACTERS",
    "FitError",
    "ModelFileError",
    "ProjectError",
    "RecordingError",
    "SpecError",
    "StribeckError",
    "listed",
    "nearest",
    "one_line",
    "option",
    "spell_options",
]


#: The longest sentence. A longer one, which repeats a long input, is cut in its middle.
MOST_CHARACTERS = 500


def one_line(text: str, most: int = MOST_CHARACTERS) -> str:
    """Return `text` on one line of at most `most` characters, without control characters.

    Examples
    --------
    >>> one_line("a\\tb\\n  c\\x1b[2J"), one_line("name " + "x" * 99 + ": rename it", 30)
    ('a b c\\\\x1b[2J', 'name xxxxx ... xxxx: rename it')
    """
    # What is far beyond the limit is dropped first: a formula may have a million characters.
    if len(text) > 8 * most:
        text = f"{text[: 4 * most]}{text[-4 * most :]}"
    line = " ".join(text.split())
    line = "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in line)
    if len(line) <= most:
        return line
    # What to do about it stands at the end.
    end = (most - 5) * 3 // 5
    return f"{line[: most - 5 - end]} ... {line[-end:]}"


class StribeckError(ValueError):
    """Base of every error a user can cause; the command line turns it into exit code 2.

    The sentence is on one line and has at most 500 characters.

    Examples
    --------
    >>> import stribeck as sb
    >>> try:
    ...     sb.model("coulom")
    ... except sb.StribeckError as error:
    ...     print(type(error).__name__)
    SpecError
    """

    def __init__(self, sentence: str = "") -> None:
        super().__init__(one_line(sentence))


class RecordingError(StribeckError):
    """A recording, its sidecar or the options that read it cannot be used.

    Examples
    --------
    >>> import numpy as np, stribeck as sb
    >>> t = np.arange(500) / 100.0
    >>> try:
    ...     sb.read({"t": t, "qd": np.sin(t), "tau": np.sin(t)}, where="qd > 9")
    ... except sb.RecordingError as error:
    ...     print(error)
    the given table: `where="qd > 9"` keeps none of 500 rows
    """


class ModelFileError(StribeckError):
    """A model file cannot be used.

    Examples
    --------
    >>> import stribeck as sb
    >>> try:
    ...     sb.read_model_file("missing.toml")
    ... except sb.ModelFileError as error:
    ...     print(error)
    cannot read the model file missing.toml: No such file or directory
    """


class ProjectError(StribeckError):
    """A project file, or the data it is about, cannot be used.

    Examples
    --------
    >>> import stribeck as sb
    >>> try:
    ...     sb.project("missing.toml")
    ... except sb.ProjectError as error:
    ...     print(error)
    cannot read the project missing.toml: No such file or directory
    """


class SpecError(StribeckError):
    """A model spec (``LAW[+effect...]``) names something that does not exist or does not fit.

    Examples
    --------
    >>> import stribeck as sb
    >>> try:
    ...     sb.model("coulomb", coulomb=2.0)
    ... except sb.SpecError as error:
    ...     print(str(error).partition("?")[0])
    coulomb has no parameter 'coulomb'; did you mean 'coulomb_friction'
    """


class FitError(StribeckError):
    """A model cannot be identified from a recording.

    Examples
    --------
    >>> import numpy as np, stribeck as sb
    >>> t = np.arange(500) / 100.0
    >>> r = sb.Recording.from_columns(time=t, velocity=np.sin(t), torque=np.sign(np.sin(t)))
    >>> try:
    ...     sb.fit("coulomb", r.where("time < 0.05"))
    ... except sb.FitError as error:
    ...     print(error)
    the given table has 4 moving samples, coulomb needs at least 5: record more motion
    """


def nearest(name: str, options: Iterable[str]) -> str:
    """Return a hint ``"; did you mean 'x'?"`` for a mistyped name, or an empty string.

    Parameters
    ----------
    name
        What was typed.
    options
        What would have been accepted.
    """
    by_folded = {option.casefold(): option for option in options}
    found = difflib.get_close_matches(name.casefold(), list(by_folded), n=1, cutoff=0.6)
    return f"; did you mean '{by_folded[found[0]]}'?" if found else ""


#: Characters of a list of names in a sentence.
_LISTED = 200


def joint_called(name: str) -> str:
    """A joint in a sentence: its name alone where that says that it is a joint.

    Examples
    --------
    >>> joint_called("2"), joint_called("joint_2")
    ('joint 2', 'joint_2')
    """
    return name if name.lower().startswith("joint") else f"joint {name}"


def listed(names: Iterable[str]) -> str:
    """Names separated by commas; of many, or of long ones, the first and how many there are more.

    Examples
    --------
    >>> listed(["t", "q"]), listed(str(i) for i in range(3000))[-24:]
    ('t, q', '49, 50, 51 and 2948 more')
    """
    every = list(names)
    shown, size = [], 0
    for name in every:
        size += len(name) + 2
        if size > _LISTED and len(every) > 1:
            break
        shown.append(name)
    left = len(every) - len(shown)
    text = ", ".join(shown) if shown else f"{every[0][:_LISTED]}..." if every else ""
    left -= not shown and bool(every)
    return f"{text} and {left} more" if left else text


_OPTION = re.compile(
    r"option `(?P<bare>\w+)`"
    r"|`(?P<name>\w+)=(?:\"(?P<text>.*?)\"|\[\"(?P<texts>.*?)\"\]|(?P<number>[^\s\"\[]+?))`"
)


def option(name: str, *values: str | float) -> str:
    """An option as sentences name it, with the value to give or the value that was given.

    Examples
    --------
    >>> option("map", "time=COLUMN"), option("gear_ratio", 0.0), option("where")
    ('`map="time=COLUMN"`', '`gear_ratio=0`', 'option `where`')
    >>> option("map", "time=t", "velocity=v")
    '`map=["time=t", "velocity=v"]`'
    """
    if not values:
        return f"option `{name}`"
    if len(values) > 1:
        return "`{}=[{}]`".format(name, ", ".join(f'"{value}"' for value in values))
    (value,) = values
    return f'`{name}="{value}"`' if isinstance(value, str) else f"`{name}={value:g}`"


def spell_options(text: str, spell: Callable[[str, str | None], str]) -> str:
    """Replace every option that `option` wrote by what `spell` returns for its name and value.

    An option with several values is spelt once for each of them.

    Examples
    --------
    >>> spell_options(f"use {option('where')}", lambda name, value: f"--{name}")
    'use --where'
    """

    def replaced(found: re.Match[str]) -> str:
        name, texts = found["name"], found["texts"]
        if name is None:
            return spell(found["bare"], None)
        if texts is not None:
            return " ".join(spell(name, value) for value in texts.split('", "'))
        return spell(name, found["number"] if found["text"] is None else found["text"])

    return _OPTION.sub(replaced, text)
