"""What a recording was made from."""

from __future__ import annotations

from dataclasses import dataclass

from stribeck.recording.stated.settings import Settings

__all__ = ["Origin"]


@dataclass(frozen=True)
class Origin:
    """What a recording was made from.

    Attributes
    ----------
    settings
        How its channels were read.
    channels
        Those that were read; all others were derived from them.
    notes
        How they were understood.
    files
        Path and SHA-256 of each file.
    """

    settings: Settings
    channels: tuple[str, ...]
    notes: tuple[str, ...]
    files: tuple[tuple[str, str], ...]
