"""NIST's Statistical Reference Datasets for nonlinear regression, as tables that stribeck reads.

Everything comes from NIST's own files: the model, both starts, the certified parameters with their
standard errors, and the observations. A predictor becomes the velocity, a second one the position,
and the response the friction torque; Nelson's model is of the logarithm of the response, which
`--derive` takes.
"""

from __future__ import annotations

import csv
import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

ROOT = Path(__file__).resolve().parents[2]
FOLDER = ROOT.parent / "shared" / "data" / "nist_strd"
#: Predictors by what they are called in a model and in the table that is written.
CHANNELS = {"x": "velocity", "x2": "velocity", "x1": "position"}
#: Digits that are asked of parameters and standard errors. Lanczos1 is exact to 14 digits: what is
#: left of it is rounding, and its standard errors are the size of that.
PARAMETER_DIGITS = 6.0
ERROR_DIGITS = 5.0
ROUNDING = {"Lanczos1": 2.0}
#: NIST certifies so many digits.
CERTIFIED = 11.0


@dataclass(frozen=True)
class Certified:
    """One data set.

    Attributes
    ----------
    response, law : str
        Left and right side of the model, in the words of a formula over channels.
    starts : two dicts
        NIST's starting values by parameter; the first are far away, the second near.
    values, errors : dict
        Certified parameters and standard errors.
    columns : dict of arrays [n]
        The observations: ``y`` and the predictors.
    """

    name: str
    response: str
    law: str
    starts: tuple[dict[str, float], dict[str, float]]
    values: dict[str, float]
    errors: dict[str, float]
    columns: dict[str, Array]

    @property
    def error_digits(self) -> float:
        """Digits that are asked of the standard errors."""
        return ROUNDING.get(self.name, ERROR_DIGITS)

    @property
    def reading(self) -> dict[str, list[str] | str]:
        """The options with which the written table is read."""
        maps = [f"{CHANNELS[name]}={name}" for name in self.columns if name in CHANNELS]
        derive = [f"friction_torque={self.response}"]
        return {"map": maps, "derive": derive, "average": "row", "rows": "all"}

    def write(self, folder: Path) -> Path:
        """Write the observations as CSV, with all their digits."""
        path = folder / f"{self.name}.csv"
        with path.open("w", newline="") as stream:
            writer = csv.writer(stream)
            writer.writerow(self.columns)
            columns = (column.tolist() for column in self.columns.values())
            writer.writerows(zip(*columns, strict=True))
        return path

    def digits(self, found: dict[str, float | None], certified: dict[str, float]) -> float:
        """Correct digits of the worst parameter; 0 where there is no value."""
        worst = CERTIFIED
        for name, value in certified.items():
            got = found[name]
            wrong = np.inf if got is None else abs(got / value - 1.0)
            worst = min(worst, CERTIFIED if wrong == 0.0 else -float(np.log10(wrong)))
        return max(worst, 0.0)


def names() -> tuple[str, ...]:
    """The data sets that are there, in alphabetical order."""
    return tuple(sorted(path.stem for path in FOLDER.glob("*.dat")))


def read(name: str) -> Certified:
    """Read one of NIST's files."""
    text = (FOLDER / f"{name}.dat").read_text()
    model = re.search(r"\n\s*(y|log\[y\])\s*=\s*(.*?)\s\+\s+e\s*\n", text, re.DOTALL)
    rows = re.findall(r"\n\s*(b\d+) =((?:\s+\S+){4})[ \t]*(?=\r?\n)", text)
    assert model is not None and rows
    table = {parameter: [float(x) for x in numbers.split()] for parameter, numbers in rows}
    count = int(_found(r"Number of Observations:\s+(\d+)", text))
    heading, *lines = text[text.rindex("Data:") :].removeprefix("Data:").splitlines()
    columns = heading.split()
    data = np.array([[float(x) for x in line.split()] for line in lines[:count]])
    assert data.shape == (count, len(columns))
    law = re.sub(r"\bx\d?\b", lambda x: CHANNELS[x[0]], " ".join(model[2].split()))
    return Certified(
        name=name,
        response=model[1].replace("[", "(").replace("]", ")"),
        law=law,
        starts=tuple({p: row[k] for p, row in table.items()} for k in (0, 1)),
        values={p: row[2] for p, row in table.items()},
        errors={p: row[3] for p, row in table.items()},
        columns=dict(zip(columns, data.T, strict=True)),
    )


def _found(pattern: str, text: str) -> str:
    match = re.search(pattern, text)
    assert match is not None, pattern
    return match[1]
