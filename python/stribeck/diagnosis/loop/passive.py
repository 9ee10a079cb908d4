"""What it costs to make a model passive that is not."""

from __future__ import annotations

from dataclasses import dataclass

from stribeck.base.errors import FitError
from stribeck.fitting.fit import fit
from stribeck.fitting.result import Fit
from stribeck.identify.search.effort import FROM_NEARBY


@dataclass(frozen=True)
class MadePassive:
    """The errors of the model refitted so that it is proved passive.

    Attributes
    ----------
    rmse, rmse_held_out
        In the unit of torque; None where no values within the bounds are passive.
    why
        Why there are none.
    """

    rmse: float | None
    rmse_held_out: float | None
    why: str | None = None

    def to_dict(self) -> dict[str, object]:
        """As JSON."""
        return {"rmse": self.rmse, "rmse_held_out": self.rmse_held_out, "why": self.why}


def cost_of_passivity(final: Fit) -> MadePassive | None:
    """The errors of `final` under passivity conditions; None where it is passive, or undecided."""
    if final.passive() is not False:
        return None
    try:
        found = fit(
            final.model,
            final.recording,
            starts=1,
            transient=final.transient,
            effort=FROM_NEARBY,
            passive=True,
        )
    except FitError as error:
        return MadePassive(None, None, str(error))
    return MadePassive(found.rmse, found.rmse_held_out)
