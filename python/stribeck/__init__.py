"""stribeck: which physical effect is a friction model missing?

Load the measurements, compare models with them, learn which effect is missing, add it, and
watch the error fall on data that the fit never saw.

>>> import stribeck as sb
>>> sb.model("coulomb", coulomb_friction=2.0, viscous_friction=0.5).torque([-1.0, 1.0])
array([-2.5,  2.5])
"""

from __future__ import annotations

import os

import polars as pl

from stribeck.compare import Comparison, compare
from stribeck.compensate import Compensator, HInfinity, Tracking, compensate, largest_factor, teach
from stribeck.design import Plan, plan
from stribeck.diagnose import Diagnosis, Finding, diagnose
from stribeck.errors import (
    FitError,
    ModelFileError,
    ProjectError,
    RecordingError,
    SpecError,
    StribeckError,
)
from stribeck.export import Export, export
from stribeck.fit import Estimate, Fit, evaluate, fit
from stribeck.fleet import Fleet, fleet
from stribeck.improve import Addition, Improvement, add, improve
from stribeck.model import Model, Parameter, catalog, law, model
from stribeck.model_file import ModelFile, load, read_model_file
from stribeck.passivity import Certificate, check
from stribeck.project import Project
from stribeck.recording import Recording, read
from stribeck.simulate import Joint, Simulation, simulate
from stribeck.streaming import Stream, StreamedFit, stream

__version__ = "0.1.0"


def project(path: str | os.PathLike[str]) -> Project:
    """Open a project file, and check that its data are the same still; see `Project`."""
    return Project.open(path)


def laws() -> pl.DataFrame:
    """The catalog of friction laws, one row a law.

    Examples
    --------
    >>> "coulomb" in laws()["id"]
    True
    """
    return _frame("laws")


def effects() -> pl.DataFrame:
    """The catalog of effects that can be missing, one row an effect.

    Examples
    --------
    >>> "load" in effects()["id"]
    True
    """
    return _frame("effects")


def _frame(kind: str) -> pl.DataFrame:
    rows = []
    for row in catalog()[kind].values():
        flat = {key: value for key, value in row.items() if key != "parameters"}
        flat["parameters"] = [p["name"] for p in row["parameters"]]
        rows.append(flat)
    return pl.DataFrame(rows)


__all__ = [
    "Addition",
    "Certificate",
    "Comparison",
    "Compensator",
    "Diagnosis",
    "Estimate",
    "Export",
    "Finding",
    "Fit",
    "FitError",
    "Fleet",
    "HInfinity",
    "Improvement",
    "Joint",
    "Model",
    "ModelFile",
    "ModelFileError",
    "Parameter",
    "Plan",
    "Project",
    "ProjectError",
    "Recording",
    "RecordingError",
    "Simulation",
    "SpecError",
    "Stream",
    "StreamedFit",
    "StribeckError",
    "Tracking",
    "add",
    "catalog",
    "check",
    "compare",
    "compensate",
    "diagnose",
    "effects",
    "evaluate",
    "export",
    "fit",
    "fleet",
    "improve",
    "largest_factor",
    "law",
    "laws",
    "load",
    "model",
    "plan",
    "project",
    "read",
    "read_model_file",
    "simulate",
    "stream",
    "teach",
]
