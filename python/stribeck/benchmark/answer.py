"""Run the diagnosis on one case; the stored result."""

from __future__ import annotations

import tempfile
import time
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from stribeck.benchmark.cases import Case
from stribeck.benchmark.coverage import Interval, intervals
from stribeck.benchmark.oracle import detection, held_out_rmse
from stribeck.benchmark.sample import Sample
from stribeck.benchmark.ties import apart

if TYPE_CHECKING:
    from stribeck.diagnosis.loop.improve import Improvement
    from stribeck.recording.recording import Recording


@dataclass(frozen=True)
class NamedEffect:
    """One effect that was added."""

    effect: str
    confidence: float
    indistinguishable_from: tuple[str, ...] = ()


@dataclass(frozen=True)
class CaseAnswer:
    """Truth and result of one case.

    Attributes
    ----------
    hidden, implied, cannot_show
        The truth: the hidden effects, the simpler effects that they contain, and those that the
        motion cannot show.
    sizes
        Actual size of each hidden effect relative to the noise.
    detectable
        Size of each hidden effect over its standard error in the generator's own model.
    apart
        The same beside the most similar of the effects that are reported as indistinguishable from
        it; None where it is not reported so.
    verdict
        Verdict of the last diagnosis.
    rmse_held_out, oracle_rmse
        Held-out RMSE of the final model, and of the generator's own formula.
    intervals
        In the group "coverage": whether each parameter's interval covers the truth.
    failure
        The error, or an empty string.
    """

    case: Case
    hidden: tuple[str, ...] = ()
    implied: tuple[str, ...] = ()
    cannot_show: tuple[str, ...] = ()
    sizes: tuple[float, ...] = ()
    detectable: tuple[float, ...] = ()
    apart: tuple[float | None, ...] = ()
    steps: tuple[NamedEffect, ...] = ()
    verdict: str = ""
    untestable: tuple[str, ...] = ()
    rmse_held_out: float | None = None
    oracle_rmse: float | None = None
    noise_rms: float | None = None
    noise_floor: float | None = None
    intervals: tuple[Interval, ...] = ()
    seconds: float = 0.0
    failure: str = ""

    @property
    def ratio(self) -> float | None:
        """Final held-out RMSE divided by that of the oracle."""
        if self.rmse_held_out is None or not self.oracle_rmse:
            return None
        return self.rmse_held_out / self.oracle_rmse

    def to_dict(self) -> dict[str, object]:
        """As JSON, which `from_dict` reads."""
        return {"name": self.case.name, **asdict(self)}

    @classmethod
    def from_dict(cls, stored: dict[str, Any]) -> CaseAnswer:
        """Read the JSON of `to_dict`.

        Raises
        ------
        KeyError, TypeError
            The JSON is not that of a case.
        """
        fields: dict[str, Any] = {k: v for k, v in stored.items() if k != "name"}
        for key in ("hidden", "implied", "cannot_show", "sizes", "detectable", "untestable"):
            fields[key] = tuple(fields[key])
        case = fields["case"]
        tuples = {key: tuple(case.get(key, ())) for key in ("effects", "nuisances", "without")}
        fields["case"] = Case(**{**case, **tuples})
        fields["apart"] = tuple(fields.get("apart", ()))
        fields["steps"] = tuple(
            NamedEffect(s["effect"], s["confidence"], tuple(s["indistinguishable_from"]))
            for s in fields["steps"]
        )
        fields["intervals"] = tuple(Interval(**i) for i in fields["intervals"])
        return cls(**fields)


def answer(case: Case) -> CaseAnswer:
    """Generate the recording of a case and diagnose it; an error is part of the result."""
    began = time.perf_counter()
    try:
        if case.group == "coverage":
            made = CaseAnswer(
                case, intervals=intervals(case.effects[0], case.seed, case.correlation)
            )
        else:
            made = _diagnosed(case)
    except Exception as error:  # one failed case must not end a run of hours
        made = CaseAnswer(case, failure=f"{type(error).__name__}: {error}")
    return CaseAnswer(**{**vars(made), "seconds": time.perf_counter() - began})


def _diagnosed(case: Case) -> CaseAnswer:
    from stribeck.diagnosis.loop.improve import improve
    from stribeck.recording.load import read

    sample = case.make()
    with tempfile.TemporaryDirectory(prefix="stribeck-benchmark-") as folder:
        path = Path(folder) / "recording.parquet"
        sample.frame.write_parquet(path)
        # What the joint is, a user states.
        recording = read(path, joint_kind=sample.truth.get("kind"))
    return _compared(case, sample, recording, improve("coulomb", recording))


def _compared(
    case: Case, sample: Sample, recording: Recording, improvement: Improvement
) -> CaseAnswer:
    truth = sample.truth
    hidden = tuple(e for e in truth["hidden"] if e != "none")
    known = [e for e in hidden if e in sample.oracle.effects]
    return CaseAnswer(
        case,
        hidden=hidden,
        implied=tuple(truth["implied"]),
        cannot_show=tuple(truth["cannot_show"]),
        sizes=tuple(truth["sizes"].values()),
        detectable=tuple(
            detection(sample.oracle, e, recording.torque, recording.moving) for e in known
        ),
        apart=tuple(apart(improvement, sample.oracle, e) for e in known),
        steps=tuple(
            NamedEffect(s.finding.effect, s.finding.confidence, s.finding.indistinguishable_from)
            for s in improvement.steps
        ),
        verdict=improvement.last.verdict,
        untestable=tuple(row.effect for row in improvement.untestable),
        rmse_held_out=improvement.final.rmse_held_out,
        oracle_rmse=held_out_rmse(
            sample.oracle, recording.torque, recording.moving, recording.block
        ),
        noise_rms=truth["noise_rms"],
        noise_floor=improvement.noise_floor.value,
    )
