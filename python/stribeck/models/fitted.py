"""What models and their files take from the result of a fit."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Protocol, TypeAlias, TypedDict, runtime_checkable

if TYPE_CHECKING:
    from stribeck.models.model import Model
    from stribeck.recording.recording import Recording


class FittedOn(TypedDict, total=False):
    """What a model was fitted to, as model files keep it.

    ``files`` has the hash of each file where there are several, ``rows`` counts the scored samples,
    ``time_span`` is the recording's first and last time in s, the errors are in the unit of the
    effort.
    """

    path: str
    sha256: str
    files: list[str]
    rows: int
    time_span: list[float]
    rmse: float
    rmse_held_out: float


#: Value and standard error of a parameter in each run, by parameter and run.
PerRun: TypeAlias = Mapping[str, Mapping[str, tuple[float, float | None]]]


@dataclass(frozen=True)
class Origin:
    """Where the values of a model come from: what a model file keeps besides them.

    Attributes
    ----------
    stderr
        Standard errors by parameter.
    """

    stderr: Mapping[str, float] = field(default_factory=dict)
    fitted_on: FittedOn = field(default_factory=FittedOn)
    per_run: PerRun = field(default_factory=dict)


def note_origin(model: Model, origin: Origin) -> None:
    """Keep where the values of a model come from, for `Model.save`.

    A model that is made from it by other values, or by `dataclasses.replace`, has no origin.
    """
    object.__setattr__(model, "_origin", origin)


@runtime_checkable
class HasModel(Protocol):
    """Anything that holds a model: a model file, a fit."""

    @property
    def model(self) -> Model:
        """The model."""


class HasStandardError(Protocol):
    """An identified parameter."""

    @property
    def stderr(self) -> float | None:
        """Standard error in the parameter's unit; None where it is not known."""


class HasValue(HasStandardError, Protocol):
    """An identified value of a parameter."""

    @property
    def value(self) -> float:
        """In the parameter's unit."""


class Fitted(HasModel, Protocol):
    """A model that was fitted to a recording."""

    @property
    def recording(self) -> Recording:
        """The recording of the fit."""

    @property
    def rmse(self) -> float:
        """RMSE of the scored samples, in the unit of the effort."""

    @property
    def rmse_held_out(self) -> float | None:
        """RMSE on held-out samples, in the same unit; None where it is not known."""

    @property
    def per_run(self) -> Mapping[str, Mapping[str, HasValue]]:
        """The values of each run, by parameter and run, where they differ."""

    @property
    def estimates(self) -> Mapping[str, HasStandardError]:
        """The identified parameters, by name."""
