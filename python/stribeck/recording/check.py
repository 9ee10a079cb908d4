"""The result of one check of a recording's channels against each other."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["Check"]


@dataclass(frozen=True)
class Check:
    """What one check found.

    Attributes
    ----------
    check
        What was compared: ``velocity``, ``torque``, ``time`` ...
    ok
        False where the channels contradict each other. True also where nothing can be concluded:
        see `is_open`.
    said
        The finding in one sentence, without a full stop.
    do
        The likeliest remedy; None where none is needed.
    trustable
        Whether a contradiction may be accepted with trust; what cannot be may not.
    """

    check: str
    ok: bool
    said: str
    do: str | None = None
    trustable: bool = True

    @property
    def is_open(self) -> bool:
        """Whether nothing can be concluded; `said` then begins with "cannot check"."""
        return self.ok and self.said.startswith("cannot check")

    def to_dict(self) -> dict[str, object]:
        """As JSON."""
        return {"check": self.check, "ok": self.ok, "said": self.said, "do": self.do}
