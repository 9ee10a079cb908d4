"""Reading TOML files that people edit: what is wrong is reported with its line."""

from __future__ import annotations

import sys
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from pathlib import Path

from stribeck.base.errors import StribeckError, nearest
from stribeck.base.replaceable import check_regular

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

__all__ = ["TomlText", "read_text"]

#: Levels of tables and lists that a file may have.
_DEEPEST = 20


def read_text(path: Path, kind: str, error: type[StribeckError]) -> str:
    """The text of a file; `kind` is what it is called where it cannot be read.

    Raises
    ------
    StribeckError
        Of the type `error`: the file cannot be read, or is not text.
    """
    check_regular(path, error)
    try:
        return path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as failure:
        reason = getattr(failure, "strerror", None) or "it is not text"
        raise error(f"cannot read the {kind} {path}: {reason}") from None


@dataclass(frozen=True)
class TomlText:
    """The text of a TOML file.

    Attributes
    ----------
    path
        The file, as errors name it.
    text
        Its content.
    error
        The type of the errors.
    under
        Words before the lines in question, where the file holds more than one table of
        the same kind.
    """

    path: Path
    text: str
    error: type[StribeckError]
    under: tuple[str, ...] = ()

    def parsed(self) -> dict[str, object]:
        """The file's content.

        Raises
        ------
        StribeckError
            Of the type `error`: the text is not TOML.
        """
        try:
            content = tomllib.loads(self.text)
        except (ValueError, RecursionError) as failure:
            # A number of thousands of digits is a ValueError of Python, a deep nest its limit.
            reason = "too deeply nested" if isinstance(failure, RecursionError) else failure
            raise self.error(f"{self.path}: not a TOML file ({reason})") from None
        self._check(content)
        return content

    def _check(self, content: object) -> None:
        """Refuse what TOML itself excludes, or no reader expects: huge numbers, deep nests."""
        level: list[tuple[str, object]] = [("", content)]
        for _ in range(_DEEPEST):
            deeper: list[tuple[str, object]] = []
            for key, value in level:
                if isinstance(value, dict):
                    deeper += value.items()
                elif isinstance(value, list):
                    deeper += [(key, item) for item in value]
                elif isinstance(value, int) and abs(value) >= 2**63:
                    raise self.stop(f"{key} is a whole number beyond 64 bits", key)
            level = deeper
        if level:
            raise self.error(f"{self.path}: tables or lists are nested too deeply")

    def stop(self, what: str, *words: str) -> StribeckError:
        """An error that names a line: that of the last of `words`, searched one after the other.

        Parameters
        ----------
        what
            What is wrong, without full stop.
        words
            Keys or headers; without any no line is named.
        """
        line = 0
        rows = self.text.splitlines()
        path = (*self.under, *words)
        for word in path:
            line = next((k for k in range(line, len(rows)) if word in rows[k]), line)
        where = f", line {line + 1}" if path else ""
        return self.error(f"{self.path}{where}: {what}")

    def check_keys(self, table: Mapping[str, object], keys: Collection[str], *words: str) -> None:
        """Refuse a `table` with other than the known `keys`."""
        for key in table:
            if key not in keys:
                hint = nearest(key, tuple(sorted(keys)))
                raise self.stop(f"key {key!r} is unknown{hint}", *words, key)
