"""The error of a model on a recording that it was not fitted to."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["Evaluated"]


@dataclass(frozen=True)
class Evaluated:
    """The error of a model on a recording that it was not fitted to.

    Attributes
    ----------
    file
        As sentences name the recording.
    rows
        Number of scored samples.
    rmse, relative_residual
        As of a fit; `rmse` in the unit of torque.
    """

    file: str
    rows: int
    rmse: float
    relative_residual: float | None

    def to_dict(self) -> dict[str, object]:
        """As JSON."""
        return {
            "file": self.file,
            "rows": self.rows,
            "rmse": self.rmse,
            "relative_residual": self.relative_residual,
        }
