"""`stream`: a data set that is larger than memory."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from stribeck.diagnosis.diagnose import LEAST_FALL
from stribeck.diagnosis.diagnose import diagnose as diagnose_in_memory
from stribeck.diagnosis.loop.improve import improve as improve_in_memory
from stribeck.fitting.fit import fit as fit_in_memory
from stribeck.fitting.result import Fit
from stribeck.identify.search import QUICK
from stribeck.models.model import Model
from stribeck.recording.excerpt import SAMPLE_ROWS
from stribeck.recording.options import ReadArguments, ReadOptions
from stribeck.recording.settings import gather
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
        start: Mapping[str, float] | None = None,
        bounds: Mapping[str, tuple[float, float]] | None = None,
        fix: Mapping[str, float] | None = None,
        told: Told = _silent,
    ) -> StreamedFit:
        """Identify `spec` on all samples by bounded least squares; see `stribeck.fit`.

        Parameters
        ----------
        told
            Called after each window with the samples done, all samples, and the number of the pass.
        """
        first = fit_in_memory(
            spec,
            self.sample.recording,
            starts=starts,
            seed=seed,
            start=start,
            bounds=bounds,
            fix=fix,
        )
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
    ) -> StreamedDiagnosis:
        """Find which effect `spec` lacks; see `stribeck.diagnose`.

        Causes are searched on the sample; the errors without and with them are over all samples.
        """
        sample = self.sample.recording
        first = fit_in_memory(spec, sample, starts=starts, seed=seed)
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
            `least_fall`, `most_steps`, `rejected`, `candidates` and `progress` of
            `stribeck.improve`.
        """
        sample = self.sample.recording
        found = improve_in_memory(
            base, sample, starts=starts, seed=seed, sample_rows=sample.rows, **options
        )
        *way, last = [found.base, *(step.after for step in found.steps)]
        # Only the errors of the intermediate models are needed.
        fits = [self._on_all_rows(fit, told, QUICK.tolerance) for fit in way]
        return StreamedImprovement(found, (*fits, self._on_all_rows(last, told)))

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
        Options of `stribeck.read`, except `average`, `drive`, `hold_out` and `standstill`.

    Raises
    ------
    RecordingError
        The data set or an option cannot be used.

    Examples
    --------
    ::

        fitted = sb.stream("logs/", map=["velocity=dq_3"]).fit("coulomb+load")
    """
    settings = gather(path, ReadOptions(**reading))
    data = DataSet.open(path)
    return Stream(data, take(data, settings, sample_rows, seed), window_rows)
