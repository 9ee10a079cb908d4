"""The temperature of a simulated joint."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from stribeck.base.errors import SpecError, option
from stribeck.base.units import ABSOLUTE_ZERO
from stribeck.models.model import Model

#: Where the friction does not depend on it and its operating box has none, degC.
USUAL = 25.0


def joint_temperature(
    friction: Model, given: ArrayLike | None, others: Sequence[Model] = ()
) -> ArrayLike:
    """The temperature as given, or the middle of the friction's operating box, degC.

    Parameters
    ----------
    friction
        What resists the motion.
    given
        One number, or one for each step.
    others
        Models beside it that may read the temperature too.

    Raises
    ------
    SpecError
        It is needed and not given, or given and not read, or below absolute zero.
    """
    if given is not None:
        if not any("temperature" in model.core.needs for model in (friction, *others)):
            raise SpecError(
                f"{option('temperature')} has no effect with {friction.spec}, only with a model "
                f"that depends on the temperature, such as one with temperature_viscous: omit it"
            )
        coldest = float(np.min(given))
        if coldest < ABSOLUTE_ZERO:
            raise SpecError(
                f"{option('temperature', coldest)} is below absolute zero: give {ABSOLUTE_ZERO} "
                f"degC or more"
            )
        return given
    if "temperature" in friction.box:
        return 0.5 * sum(friction.box["temperature"])
    if "temperature" in friction.core.needs:
        raise SpecError(f"{friction.spec} depends on the temperature: give it, in degC")
    return USUAL
