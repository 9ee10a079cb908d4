"""Results pickle, copy and go through joblib, and say the same afterwards."""

from __future__ import annotations

import copy
import pickle
from pathlib import Path

import joblib
import pytest
import stribeck as sb
from stribeck.diagnosis.inspect import inspect
from stribeck.motion.simulate.drive import Torque
from stribeck.motion.simulate.trajectory import Quintic
from stribeck.motion.simulate.validation import validate
from stribeck.report import RENDERERS
from stribeck.scale.study.study import study
from synthetic import joint, record

#: Results of whole robots, of data read in passes and of test benches, which take long to make.
#: They hold fits, recordings and numbers as the others do.
ELSEWHERE = {
    "ArmFit", "BristleStiffness", "Plan", "Robot", "RobotComparison", "RobotDiagnosis",
    "RobotFit", "RobotImprovement", "RobotPlan", "RobotTracking", "SteadyPoints",
    "StreamedDiagnosis", "StreamedFit", "StreamedImprovement", "Teaching", "Transmission",
}  # fmt: skip


@pytest.fixture(scope="module")
def results(tmp_path_factory: pytest.TempPathFactory) -> list[object]:
    """One result of each kind, or several."""
    folder: Path = tmp_path_factory.mktemp("results")
    frame = joint(rows=1500)
    path = folder / "joint.csv"
    frame.write_csv(path)
    extra = joint(0.2 * frame["load_torque"].abs() * frame["velocity"].sign(), rows=1500)
    recording = record(folder, extra)
    fitted = sb.fit("coulomb", recording)
    improvement = sb.improve("coulomb", recording, most_steps=1)
    diagnosis = sb.diagnose(fitted, recording)
    alone = sb.Joint.revolute(0.3)
    motion = Quintic(0.0, 1.0, 1.0, 0.2)
    made: list[object] = [
        recording,
        fitted,
        sb.fit("lugre", recording, starts=1),
        fitted.model,
        sb.read_model_file(_saved(fitted, folder)),
        fitted.estimates["coulomb_friction"],
        sb.compare([fitted], recording),
        diagnosis,
        diagnosis.findings[0],
        improvement,
        sb.Addition("load", fitted, sb.add(fitted, "load", recording)),
        sb.check(fitted.model),
        sb.simulate(fitted.model, alone, Torque(4.0), seconds=0.5),
        sb.compensate(fitted.model, alone, motion, [sb.Compensator(fitted.model)], seconds=0.5),
        sb.largest_factor(fitted, fitted),
        validate(fitted, recording, alone, horizons=(0.3,)),
        sb.export(fitted.model, "json", folder / "exported"),
        inspect(path),
        sb.fleet([path], folder / "fleet", "coulomb", workers=1),
        study(path, folder / "study", ["coulomb"], starts=1),
    ]
    project = sb.Project.new(folder / "p.toml", path, "coulomb")
    branched = project.add("offset")
    made += [project, branched.compare("0", "1")]
    return made


def _saved(fitted: sb.Fit, folder: Path) -> Path:
    fitted.save(folder / "m.toml")
    return folder / "m.toml"


def test_every_result_that_is_shown_is_here(results: list[object]) -> None:
    shown = {name.partition(":")[2] for name in RENDERERS}
    assert shown - {type(result).__name__ for result in results} == ELSEWHERE


def said(result: object) -> object:
    """What must be the same of a copy."""
    return result.to_dict() if hasattr(result, "to_dict") else repr(result)


def test_they_pickle_and_copy(results: list[object]) -> None:
    for result in results:
        name = type(result).__name__
        expected = repr(said(result))
        for again in (
            pickle.loads(pickle.dumps(result)),
            copy.copy(result),
            copy.deepcopy(result),
        ):
            assert type(again) is type(result), name
            assert repr(said(again)) == expected, name


@pytest.mark.slow
def test_they_go_through_joblib(results: list[object]) -> None:
    """To other processes and back."""
    again = joblib.Parallel(n_jobs=2)(joblib.delayed(copy.copy)(one) for one in results)
    for result, one in zip(results, again, strict=True):
        assert type(one) is type(result) and repr(said(one)) == repr(said(result))
