"""`stream`: a data set that is larger than memory."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

from stribeck.base.arguments import door
from stribeck.base.errors import RecordingError
from stribeck.diagnosis.diagnose import diagnose as diagnose_in_memory
from stribeck.diagnosis.least_fall import LEAST_FALL
from stribeck.diagnosis.loop.improve import improve as improve_in_memory
from stribeck.fitting.fit import fit as fit_in_memory
from stribeck.fitting.result import Fit
from stribeck.identify.scaling import model_for
from stribeck.identify.search.effort import QUICK
from stribeck.identify.stated.choices import (
    CHOICE_NAMES,
    ChoiceArguments,
    Choices,
    parameters_of_effects,
    refuse_statements,
)
from stribeck.models.model import Model
from stribeck.recording.motion.excerpt import SAMPLE_ROWS
from stribeck.recording.stated.options import ReadArguments, ReadOptions
from stribeck.recording.stated.settings import gather
from stribeck.scale.streaming.dataset import DataSet
from stribeck.scale.streaming.diagnosis import StreamedDiagnosis
from stribeck.scale.streaming.fit import streamed_fit
from stribeck.scale.streaming.improvement import StreamedImprovement
from stribeck.scale.streaming.passes import Told
from stribeck.scale.streaming.result import StreamedFit
from stribeck.scale.streaming.sample import Sample, take
from stribeck.scale.streaming.windows import WINDOW_ROWS

if TYPE_CHECKING:
    from typing_extensions import Unpack

__all__ = ["Stream", "stream"]


def _silent(done: int, total: int, number: int) -> None:
    """Report no progress."""


@dataclass(frozen=True)
class Stream:
    """Measurements of a joint in Parquet files; only a part of them is in memory.

    Attributes
    ----------
    data
        The files.
    sample
        Contiguous parts of them.
    window_rows
        Number of rows in memory at a time, in addition to the sample.

    Examples
    --------
    >>> import numpy as np, polars as pl, stribeck as sb, tempfile
    >>> v = np.sin(np.arange(900) / 50.0)
    >>> frame = pl.DataFrame({"t": np.arange(900) / 100.0, "qd": v, "tau": v + np.sign(v)})
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     frame.write_parquet(f"{folder}/log.parquet")
    ...     opened = sb.stream(folder, sample_rows=400)
    ...     opened.sample.recording.rows, opened.fit("coulomb", starts=1).rows
    (400, 900)
    """

    data: DataSet
    sample: Sample
    window_rows: int = WINDOW_ROWS

    def fit(
        self,
        spec: str | Model,
        *,
        starts: int = 20,
        seed: int = 0,
        told: Told = _silent,
        **choices: Unpack[ChoiceArguments],
    ) -> StreamedFit:
        """Identify `spec` on all samples by bounded least squares; see `stribeck.fit`.

        Parameters
        ----------
        told
            Called after each window with the samples done, all samples, and the number of the pass.
        **choices
            `start`, `bounds` and `fix` of `stribeck.fit`.
        """
        made = self._stated(spec, choices, {})
        first = fit_in_memory(made, self.sample.recording, starts=starts, seed=seed)
        return streamed_fit(self.data, self.sample, first, told=told, window_rows=self.window_rows)

    def diagnose(
        self,
        spec: str | Model,
        *,
        starts: int = 20,
        seed: int = 0,
        least_fall: float = LEAST_FALL,
        candidates: Collection[str] = (),
        told: Told = _silent,
        **choices: Unpack[ChoiceArguments],
    ) -> StreamedDiagnosis:
        """Find which effect `spec` lacks; see `stribeck.diagnose`.

        Causes are searched on the sample; the errors without and with them are over all samples.
        """
        sample = self.sample.recording
        later = parameters_of_effects(candidates=candidates)
        made = self._stated(spec, choices, later)
        first = fit_in_memory(made, sample, starts=starts, seed=seed)
        found = diagnose_in_memory(
            first,
            sample,
            least_fall=least_fall,
            candidates=candidates,
            seed=seed,
            sample_rows=sample.rows,
        )
        return StreamedDiagnosis(
            found,
            self._on_all_rows(first, told),
            tuple(self._on_all_rows(f.fit, told, QUICK.tolerance) for f in found.findings),
        )

    def improve(
        self,
        base: str | Model,
        *,
        starts: int = 20,
        seed: int = 0,
        told: Told = _silent,
        **options: Any,
    ) -> StreamedImprovement:
        """Diagnose and add effects until the residual is noise; see `stribeck.improve`.

        Causes are searched on the sample; each step's model is then identified on all samples.

        Parameters
        ----------
        **options
            `least_fall`, `most_steps`, `rejected`, `candidates`, `progress`, `start`, `bounds` and
            `fix` of `stribeck.improve`.
        """
        sample = self.sample.recording
        choices = {name: options.pop(name) for name in CHOICE_NAMES if name in options}
        later = parameters_of_effects(candidates=options.get("candidates", ()))
        start = self._stated(base, cast(ChoiceArguments, choices), later)
        found = improve_in_memory(
            start, sample, starts=starts, seed=seed, sample_rows=sample.rows, **options
        )
        *way, last = [found.base, *(step.after for step in found.steps)]
        # Only the errors of the intermediate models are needed.
        fits = [self._on_all_rows(fit, told, QUICK.tolerance) for fit in way]
        return StreamedImprovement(found, (*fits, self._on_all_rows(last, told)))

    def _stated(
        self, spec: str | Model, choices: ChoiceArguments, later: Mapping[str, str]
    ) -> Model:
        """The model with what is stated about its parameters; refuse what needs all samples."""
        made = Choices.of(choices).applied(model_for(spec, self.sample.recording), later)
        refuse_statements(made, "a fit to data read in passes")
        return made

    def _on_all_rows(self, start: Fit, told: Told, tolerance: float | None = None) -> StreamedFit:
        return streamed_fit(
            self.data,
            self.sample,
            start,
            told=told,
            window_rows=self.window_rows,
            tolerance=tolerance,
        )

    def __repr__(self) -> str:
        files = len(self.data.files)
        return (
            f"<Stream {self.data.path}: {self.data.rows} samples in {files} "
            f"file{'s' if files > 1 else ''}, {self.sample.recording.rows} of them in memory>"
        )


@door(RecordingError)
def stream(
    path: str | Path,
    *,
    sample_rows: int = SAMPLE_ROWS,
    window_rows: int = WINDOW_ROWS,
    seed: int = 0,
    **reading: Unpack[ReadArguments],
) -> Stream:
    """Open a data set that is read in passes, one window at a time.

    Parameters
    ----------
    path
        A Parquet file, a folder of them (in the order of their names), or a pattern.
    sample_rows
        Number of samples in memory: forty contiguous parts, one in each fortieth of the data set.
        They give the velocity noise, bounds and starts, and are used by a diagnosis.
    window_rows
        Number of samples read at a time, which determines the memory used. For models without a
        memory on recorded columns it changes results by rounding only.
    seed
        Seed of the positions of the parts.
    **reading
        Options of `stribeck.read`, except `average`, `drive`, `hold_out`, `standstill` and
        `weights`.

    Raises
    ------
    RecordingError
        The data set or an option cannot be used.

    Examples
    --------
    >>> import numpy as np, polars as pl, stribeck as sb, tempfile
    >>> v = np.sin(np.arange(900) / 50.0)
    >>> frame = pl.DataFrame({"t": np.arange(900) / 100.0, "speed": v, "tau": v + np.sign(v)})
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     frame.write_parquet(f"{folder}/log.parquet")
    ...     found = sb.stream(folder, map=["velocity=speed"]).fit("coulomb", starts=1)
    >>> round(found.estimates["coulomb_friction"].value, 3)
    1.0
    """
    settings = gather(path, ReadOptions.of(reading))
    data = DataSet.open(path)
    return Stream(data, take(data, settings, sample_rows, seed), window_rows)
