"""The output of a generator: a recording, its truth, and the true model."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, TypeAlias

import numpy as np
import polars as pl
from numpy.typing import NDArray

Array = NDArray[np.float64]


#: What is hidden in a recording, as it is stored.
Truth: TypeAlias = dict[str, Any]


@dataclass(frozen=True)
class Oracle:
    """The generator's formula linearised at its true parameters, at the recorded channels.

    Attributes
    ----------
    prediction : array [n]
        Torque at the true parameters.
    tangents : dict of arrays [n]
        Derivative of the torque with respect to each parameter, by name, relative to its true
        value. The torque is nearly linear in the amplitudes, so one least-squares step from the
        true values refits them.
    effects : dict of arrays [n]
        What the prediction loses without each hidden effect.
    contained : dict of arrays [n]
        Shape of each simpler effect that a hidden one contains.
    nuisances : tuple of arrays [n]
        What each nuisance adds to the torque, to the load torque, and by velocity and temperature
        to the torque of Coulomb and viscous friction: shapes of unknown size.
    """

    prediction: Array
    tangents: Mapping[str, Array]
    effects: Mapping[str, Array] = field(default_factory=dict)
    contained: Mapping[str, Array] = field(default_factory=dict)
    nuisances: tuple[Array, ...] = ()

    def through(self, chain: Callable[[Array], Array]) -> Oracle:
        """The same where the torque is measured behind a `chain`, a nuisance."""
        prediction = chain(self.prediction)

        def changed(columns: Mapping[str, Array]) -> dict[str, Array]:
            return {
                name: chain(self.prediction + column) - prediction
                for name, column in columns.items()
            }

        return Oracle(
            prediction,
            changed(self.tangents),
            changed(self.effects),
            changed(self.contained),
            (*self.nuisances, prediction - self.prediction),
        )

    def with_nuisance(self, added: Array) -> Oracle:
        """The same with what a nuisance adds by another channel, array [n]."""
        return replace(self, nuisances=(*self.nuisances, added))

    def kept(self, rows: NDArray[np.bool_]) -> Oracle:
        """The same with some of the rows, bool [n]."""

        def of(columns: Mapping[str, Array]) -> dict[str, Array]:
            return {name: column[rows] for name, column in columns.items()}

        return Oracle(
            self.prediction[rows],
            of(self.tangents),
            of(self.effects),
            of(self.contained),
            tuple(column[rows] for column in self.nuisances),
        )


@dataclass(frozen=True)
class Sample:
    """One recording with hidden effects.

    Attributes
    ----------
    frame : polars.DataFrame
        The recording: time, position, velocity, acceleration, torque, load_torque, temperature.
    truth : dict
        ``hidden`` (or ``["none"]``), ``implied`` (simpler effects that a hidden one contains),
        ``cannot_show``, ``sizes`` relative to the noise, ``noise_rms`` and the random quantities.
    oracle : Oracle
        The best possible model of this recording.
    """

    frame: pl.DataFrame
    truth: Truth
    oracle: Oracle


def tangents(
    predict: Callable[[Mapping[str, float]], Array],
    values: Mapping[str, float],
    prediction: Array,
    step: float = 1e-3,
) -> dict[str, Array]:
    """Derivatives of a prediction with respect to relative changes of its parameters."""
    return {
        name: (predict({**values, name: value * (1 + step)}) - prediction) / step
        for name, value in values.items()
    }
