"""Writing models as TOML; numbers are written so that they read back with the same bits."""

from __future__ import annotations

import math
import os
from collections.abc import Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING

import tomlkit
from tomlkit.items import Table

from stribeck.base.errors import ModelFileError
from stribeck.base.files import write_whole
from stribeck.models.catalog import constants_read

if TYPE_CHECKING:
    from stribeck.models.fitted import FittedOn, PerRun
    from stribeck.models.model import Model

#: Version of the file's layout.
SCHEMA = 1
_NOTHING: Mapping[str, float] = MappingProxyType({})


def write_model(
    model: Model,
    path: str | os.PathLike[str],
    stderr: Mapping[str, float] = _NOTHING,
    fitted_on: FittedOn | None = None,
    per_run: PerRun | None = None,
) -> None:
    """Write a model file whole or not at all.

    Parameters
    ----------
    model
        With a value for each parameter.
    path
        An existing file is replaced.
    stderr
        Standard errors by parameter name, in the parameters' units.
    fitted_on
        Provenance, as in `stribeck.ModelFile`.
    per_run
        Value and standard error by parameter and run, of parameters that have one in each run.

    Raises
    ------
    ModelFileError
        A parameter has no value, or the path cannot be written.
    """
    unknown = [
        name
        for name, value in zip(model.names, model.values, strict=True)
        if not math.isfinite(value)
    ]
    if unknown:
        raise ModelFileError(
            f"{model.spec} has no value for {', '.join(unknown)}: fit it before saving"
        )
    write_whole(path, model_toml(model, stderr, fitted_on or {}, per_run or {}), ModelFileError)


def model_toml(
    model: Model, stderr: Mapping[str, float], fitted_on: FittedOn, per_run: PerRun
) -> str:
    """The text of a model file."""
    document = tomlkit.document()
    add_model(document, model, stderr, fitted_on, per_run)
    return tomlkit.dumps(document)


def add_model(
    document: tomlkit.TOMLDocument | Table,
    model: Model,
    stderr: Mapping[str, float],
    fitted_on: FittedOn,
    per_run: PerRun,
) -> None:
    """Add what a model file holds to a document or table."""
    document.add("kind", tomlkit.item("model"))
    document.add("schema", tomlkit.item(SCHEMA))
    document.add("law", tomlkit.item(model.law))
    document.add("effects", tomlkit.item(list(model.effects)))
    document.add("rigid_body", tomlkit.item(list(model.rigid_body)))
    document.add("torque_unit", tomlkit.item(model.torque_unit))
    document.add("position_unit", tomlkit.item(model.position_unit))
    if model.drive is not None:
        document.add("drive", tomlkit.item(model.drive))
    if model.own:
        document.add("formulas", _table({terms.name: terms.text for terms in model.own}))
    # An effect that was taken out may have left its constants behind.
    constants = constants_read(model.constants, model.law, model.effects)
    if constants:
        document.add("constants", _table({k: float(v) for k, v in constants.items()}))
    document.add("parameters", _parameters(model, stderr, per_run))
    if fitted_on:
        document.add("fitted_on", _table(fitted_on))
    if model.box:
        box = {name: [float(low), float(high)] for name, (low, high) in model.box.items()}
        document.add("box", _table(box))


def _parameters(model: Model, stderr: Mapping[str, float], per_run: PerRun) -> Table:
    rows = tomlkit.table(is_super_table=True)
    of_formulas = {name for terms in model.own for name in terms.names}
    for p, value in zip(model.parameters, model.values, strict=True):
        # The bounds of a formula's parameter are stated nowhere else.
        stated = (p.lower, p.upper) if p.name in of_formulas else None
        bounds = model.bounds.get(p.name, stated)
        row: dict[str, object] = {"value": float(value), "symbol": p.symbol, "unit": p.unit}
        if bounds is not None and bounds != (-math.inf, math.inf):
            row["bounds"] = [float(end) for end in bounds]
        if stderr.get(p.name) is not None:
            row["stderr"] = stderr[p.name]
        table = _table(row)
        if p.name in per_run:
            table.add("per_run", _of_runs(per_run[p.name]))
        rows.add(p.name, table)
    return rows


def _of_runs(values: Mapping[str, tuple[float, float | None]]) -> Table:
    """Value and standard error of each run, one line a run."""
    table = tomlkit.table()
    for run, (value, stderr) in values.items():
        row = tomlkit.inline_table()
        row.append("value", float(value))
        if stderr is not None:
            row.append("stderr", float(stderr))
        table.add(run, row)
    return table


def _table(values: Mapping[str, object]) -> Table:
    table = tomlkit.table()
    for key, value in values.items():
        table.add(key, tomlkit.item(value))
    return table
