"""What every effect states: the fields of `Effect`, and the types that they use."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from stribeck.effect.facts import RecordingFacts
from stribeck.models.model import Model
from stribeck.recording.recording import Recording

Array = NDArray[np.float64]


class Identified(Protocol):
    """A model identified on a recording: what the functions of an effect may read of a fit."""

    @property
    def model(self) -> Model:
        """The model with its values."""

    @property
    def recording(self) -> Recording:
        """The recording."""

    @property
    def rows(self) -> NDArray[np.intp]:
        """Samples that the parameters were fitted to, int array [m]."""

    @property
    def prediction(self) -> Array:
        """Modelled motor torque of every sample, array [n]."""

    @property
    def load(self) -> Array | None:
        """Load torque identified with the friction, array [n]; None where it was recorded."""


class JointSizes(Protocol):
    """Sizes of a joint in SI units, from which plausible parameter values follow."""

    @property
    def stroke(self) -> float:
        """Range of the motion, rad or m."""

    @property
    def speed(self) -> float:
        """Top speed, rad/s or m/s."""

    @property
    def coulomb(self) -> float:
        """Coulomb friction, N m or N."""

    @property
    def viscous(self) -> float:
        """Viscous coefficient, N m s/rad or N s/m."""

    @property
    def inertia(self) -> float:
        """Inertia or mass, kg m^2 or kg."""

    @property
    def gravity(self) -> float:
        """Gravity torque of the nominal payload, N m or N."""


@dataclass(frozen=True)
class GeneratedRecording:
    """Sizes of a recording that is about to be generated.

    Attributes
    ----------
    seconds
        Duration, s.
    middle_temperature
        Middle of the range of temperatures, degC.
    """

    joint: JointSizes
    seconds: float
    middle_temperature: float


@dataclass(frozen=True)
class Obstacle:
    """Why a recording cannot show an effect, and the motion or sensor that would."""

    why: str
    do: str


@dataclass(frozen=True)
class ResidualView:
    """How the residual of a model that lacks an effect is drawn to show it.

    Attributes
    ----------
    channel
        A channel of `stribeck.report.channels`.
    along
        Sign of the residual: with ``"motion"`` it is positive where friction is larger than
        modelled, with ``"load"`` where the motor carries more load; None: as it is.
    regime
        The samples in which the effect shows best: a regime of `stribeck compare`, or
        ``"sliding"`` for those away from reversals; None: all.
    log
        Whether the effect shows within a small part of the channel's range.
    """

    channel: str
    along: Literal["motion", "load"] | None = None
    regime: str | None = None
    log: bool = False


@dataclass(frozen=True)
class FixedForm:
    """An effect whose dependence on a channel is fixed by physics.

    Attributes
    ----------
    channel
        The channel.
    free_functions
        Free functions of that channel on the samples fitted to, arrays [m].
    alike
        Effects of that channel, of any form, whose torque may be the one that was identified. They
        are alternatives where a free function adds to the fixed form.
    """

    channel: str
    free_functions: Callable[[Identified], list[Array]]
    alike: Callable[[Identified], tuple[str, ...]] = lambda _: ()


@dataclass(frozen=True)
class FreeForm:
    """Friction as any function of what it may depend on.

    Attributes
    ----------
    of
        What it depends on, in words.
    columns
        The function, as columns on the samples fitted to, arrays [m].
    """

    of: str
    columns: Callable[[Identified], list[Array]]


#: What an effect does in a simulated motion.
InMotion = Literal["acts", "measurement", "drive train"]


def _nothing(*_: object) -> None:
    return None


def _many(_: Identified) -> float:
    return np.inf


def _no_constants(*_: object) -> dict[str, float]:
    return {}


def _no_columns(_: Identified) -> list[Array]:
    return []


def _no_names(_before: Identified, _after: Identified) -> tuple[str, ...]:
    return ()


def _one_form(_: Recording) -> int:
    return 1


@dataclass(frozen=True)
class Effect:
    """One effect of the catalog, as the Python package needs it.

    Attributes
    ----------
    id
        As in the catalog; the file has the same name.
    view
        How the residual is drawn to show the effect.
    obstacle
        Why a recording cannot show the effect; None where it can.
    where
        One sentence with numbers and units, without a full stop: where the data shows the effect.
        Its arguments are the fits without and with the effect.
    plausible
        A value for each of the parameters, large enough to see, on a joint of given sizes.
    constants
        The constants that the effect names in the catalog, from a recording; none where it lacks
        a channel.
    constants_beside
        Those that depend on the model beside which the effect is added. Arguments: the recording,
        the load torque [n] that is identified with the friction, and the residual [n] without the
        effect; each of the arrays may be None.
    generated_constants
        The constants in a generated recording.
    refusal
        Why a model with the effect cannot be fitted to a recording, as a sentence; None where it
        can. A missing column that the catalog names need not be checked here.
    flexible_shape
        Columns on the samples fitted to, arrays [m], that let the effect take any smooth form.
        Before a second cause is claimed, the residual must not be explained by these.
    free_form
        The free function of the motion of which the effect is one form; None where a function that
        explains more would confirm the effect, as one of the load torque does.
    series
        Whether its parameters are the terms of a series, which no sample determines beyond the
        range that it covers.
    fixed_form
        The channel on which the effect depends in a form fixed by physics.
    size_range
        Where the torque is not proportional to the first parameter: the multiples of its start
        between which the smallest visible effect is searched, from large effects to small ones.
    forms
        How many forms a fit chooses from by looking at the data; they count as so many tests.
    unresolved
        Why the effect acts within what the recording resolves, as a clause: a distance between two
        samples, a lag of a small part of one; None where it does not.
    samples_late
        By how many samples it delays friction. A late channel looks like a few samples, so that the
        effect must then predict better than all causes in the measurement; below one sample it is
        never certain.
    beyond_band
        Why it acts above the frequencies at which the motion is known, as a clause; it is then as
        likely as not. None where it does not.
    out_of_reach
        Why it acts beyond what the recording reaches, as a clause: a time constant longer than a
        move, a speed above the highest; None where it does not.
    absorbed
        Why the recording cannot show the effect beside those of a model; None where it can.
    alike
        Other effects that the recording cannot tell from it once it is identified: a sensor is
        missing, or its torque follows theirs.
    part_of
        Another effect that contains this one on any motion.
    acts_alone
        Whether it also acts without the simpler effect of the catalog that it contains.
    in_shocks
        Whether it acts in shocks, which are faster than the motion and few samples long.
    design_note
        What no designed motion can do for the effect, as a sentence without a full stop.
    in_motion
        Whether the effect acts as torque, distorts the measurement only, or describes a drive
        train by what it does to a recorded load torque.
    cannot_hide
        Why the effect cannot be hidden in a generated recording, given the hidden model and the
        load torque [n].
    shown_beside
        An effect without which it has no influence, to show it with.
    steady
        Effects that together are this one where nothing changes with time.
    """

    id: str
    view: ResidualView
    obstacle: Callable[[RecordingFacts], Obstacle | None]
    where: Callable[[Identified, Identified], str]
    plausible: Callable[[JointSizes, np.random.Generator], dict[str, float]]
    constants: Callable[[Recording], dict[str, float]] = _no_constants
    constants_beside: Callable[[Recording, Array | None, Array | None], dict[str, float]] = (
        _no_constants
    )
    generated_constants: Callable[[GeneratedRecording], dict[str, float]] = _no_constants
    refusal: Callable[[Model, Recording], str | None] = _nothing
    flexible_shape: Callable[[Identified], list[Array]] = _no_columns
    free_form: FreeForm | None = None
    series: bool = False
    fixed_form: FixedForm | None = None
    size_range: tuple[float, float] | None = None
    forms: Callable[[Recording], int] = _one_form
    unresolved: Callable[[Identified], str | None] = _nothing
    samples_late: Callable[[Identified], float] = _many
    beyond_band: Callable[[Identified], str | None] = _nothing
    out_of_reach: Callable[[Identified], str | None] = _nothing
    absorbed: Callable[[Model, Recording], Obstacle | None] = _nothing
    alike: Callable[[Identified, Identified], tuple[str, ...]] = _no_names
    part_of: str | None = None
    acts_alone: bool = False
    in_shocks: bool = False
    design_note: str = ""
    in_motion: InMotion = "acts"
    cannot_hide: Callable[[Model, Array], str | None] = _nothing
    shown_beside: str | None = None
    steady: tuple[str, ...] = ()


def number(value: float, digits: int = 3) -> str:
    """`digits` significant digits, for sentences; an exponent only from a million on.

    Examples
    --------
    >>> number(0.012345), number(1234.5), number(1.5e7)
    ('0.0123', '1230', '1.5e+07')
    >>> number(1234.5, 2)
    '1200'
    """
    return f"{float(f'{value:.{digits}g}'):g}"
