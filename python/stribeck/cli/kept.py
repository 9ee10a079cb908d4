"""The last result, kept in the user's cache so that nothing is lost when `-o` was forgotten."""

from __future__ import annotations

import contextlib
import json
import os
import sys
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass
from datetime import datetime
from pathlib import Path

import click

from stribeck.base.errors import StribeckError
from stribeck.base.files import write_bytes_whole
from stribeck.cli.outputs import COMMAND
from stribeck.fitting.result import Fit
from stribeck.models.model_file import ModelFile

__all__ = ["SWITCH", "Kept", "keep", "kept", "kept_path"]

#: The variable that switches this off, with one of these values.
SWITCH = "STRIBECK_LAST"
OFF = ("0", "off", "no", "false")
#: Largest file, bytes; of a larger result the JSON is left out first.
MOST_BYTES = 4_000_000
#: Where results hold the model that they end with.
_MODELS = ("result", "found", "final", "after", "fit")


@dataclass(frozen=True)
class Kept:
    """A result as it was printed.

    Attributes
    ----------
    command, folder, time
        The words of the command, where it ran, and when it ended.
    text
        What was printed; None where that was the JSON.
    json
        The JSON object; None where it was too large.
    model
        The text of its model or robot file; None where the result has no single model.
    """

    command: str
    folder: str
    time: str
    text: str | None
    json: Mapping[str, object] | None
    model: str | None


def kept_path() -> Path:
    """The file of the last result, in the cache folder of the user."""
    home = Path.home()
    if sys.platform == "win32":
        folder = Path(os.environ.get("LOCALAPPDATA") or home / "AppData" / "Local")
    elif sys.platform == "darwin":
        folder = home / "Library" / "Caches"
    else:
        folder = Path(os.environ.get("XDG_CACHE_HOME") or home / ".cache")
    return folder / "stribeck" / "last.json"


def is_off() -> bool:
    """Whether the user has switched this off."""
    return os.environ.get(SWITCH, "").lower() in OFF


def keep(
    result: object,
    text: str | None,
    as_json: Callable[[], Mapping[str, object]],
    file_text: Callable[[], str] | None = None,
) -> bool:
    """Keep a result that was printed; whatever fails here, the command has its result.

    Returns
    -------
    bool
        Whether a model is kept that no file holds.

    Parameters
    ----------
    text
        What was printed; None: the JSON.
    as_json
        Gives the JSON object.
    file_text
        Gives the text of the file that `-o` would write, where that is no model file.
    """
    if is_off():
        return False
    # A full disk, a home that cannot be written to, a result without JSON: none of it is a reason
    # for a command that has done its work to fail.
    with contextlib.suppress(Exception):
        context = click.get_current_context(silent=True)
        command = "" if context is None else str(context.meta.get(COMMAND, ""))
        now = datetime.now().isoformat(sep=" ", timespec="seconds")
        model = _model_text(result) if file_text is None else file_text()
        _write(Kept(command, os.getcwd(), now, text, as_json(), model))
        unsaved = context is not None and context.params.get("output", "") is None
        return unsaved and model is not None
    return False


def _write(found: Kept) -> None:
    row = asdict(found)
    content = json.dumps(row, allow_nan=False).encode()
    if len(content) > MOST_BYTES and found.text is not None:
        content = json.dumps({**row, "json": None}, allow_nan=False).encode()
    path = kept_path()
    if len(content) > MOST_BYTES:
        # An older result must not pass for this one.
        path.unlink(missing_ok=True)
        return
    path.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
    write_bytes_whole(path, content, told=False)


def _model_text(result: object) -> str | None:
    """The model file of the model that a result ends with; None where there is no single one."""
    found = result
    while not isinstance(found, Fit):
        inner = next((name for name in _MODELS if hasattr(found, name)), None)
        if hasattr(found, "model_file"):
            return str(found.model_file().to_toml())
        if inner is None:
            return None
        found = getattr(found, inner)
    return ModelFile.of(found).to_toml()


def kept() -> Kept:
    """The last result.

    Raises
    ------
    StribeckError
        There is none, or its file cannot be read.
    """
    path = kept_path()
    try:
        row = json.loads(path.read_text(encoding="utf-8"))
        return Kept(**row)
    except FileNotFoundError:
        why = f"the variable {SWITCH} switches it off" if is_off() else "run a command first"
        raise StribeckError(f"no result is kept: {why}") from None
    except OSError as error:
        raise StribeckError(f"cannot read {path}: {error.strerror or error}") from None
    except (ValueError, TypeError):
        raise StribeckError(f"{path} is damaged: remove it") from None
