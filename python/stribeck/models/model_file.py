"""Model files: a model, what it was fitted on and its operating box, as editable TOML."""

from __future__ import annotations

import math
import os
import sys
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import tomlkit

from stribeck.base.errors import ModelFileError, SpecError, nearest
from stribeck.models.catalog import law_ids
from stribeck.models.formula_law import Declaration, FormulaTerms
from stribeck.models.model import Model, check_terms
from stribeck.models.spec import parse_effects, parse_spec

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

if TYPE_CHECKING:
    from stribeck.fitting.result import Fit

SCHEMA = 1
TOP_KEYS = {
    "kind", "schema", "law", "effects", "rigid_body", "torque_unit", "position_unit",
    "constants", "parameters", "fitted_on", "box", "drive", "formulas",
}  # fmt: skip
PARAMETER_KEYS = {"value", "symbol", "unit", "bounds", "stderr"}
BOX_KEYS = {
    "velocity", "position", "acceleration", "temperature", "load_torque", "motor_torque",
    "external_torque",
}  # fmt: skip
FITTED_KEYS = {"path", "sha256", "rows", "time_span", "rmse", "rmse_held_out"}


@dataclass(frozen=True)
class ModelFile:
    """A model with its standard errors and provenance, as stored.

    Attributes
    ----------
    stderr : dict
        Standard errors by parameter name, where known.
    fitted_on : dict
        ``path``, ``sha256``, ``rows``, ``time_span`` [s, s], ``rmse``, ``rmse_held_out``.
    """

    model: Model
    stderr: Mapping[str, float] = field(default_factory=dict)
    fitted_on: Mapping[str, Any] = field(default_factory=dict)

    @classmethod
    def of(cls, fitted: Fit) -> ModelFile:
        """What is kept of a fit: its model, standard errors and provenance."""
        r = fitted.recording
        fitted_on: dict[str, Any] = {
            "path": r.path,
            "sha256": r.sha256,
            "rows": int(r.moving.sum()),
            "time_span": [float(r.time[0]), float(r.time[-1])],
            "rmse": fitted.rmse,
        }
        if fitted.rmse_held_out is not None:
            fitted_on["rmse_held_out"] = fitted.rmse_held_out
        errors = {n: e.stderr for n, e in fitted.estimates.items() if e.stderr is not None}
        return cls(fitted.model, errors, fitted_on)

    def to_toml(self) -> str:
        """The file's text; numbers are written so that they read back with the same bits."""
        document = tomlkit.document()
        self.write_into(document)
        return tomlkit.dumps(document)

    def write_into(self, document: Any) -> None:
        """Add what the file holds to a document or table of tomlkit."""
        m = self.model
        document.add("kind", tomlkit.item("model"))
        document.add("schema", tomlkit.item(SCHEMA))
        document.add("law", tomlkit.item(m.law))
        document.add("effects", tomlkit.item(list(m.effects)))
        document.add("rigid_body", tomlkit.item(list(m.rigid_body)))
        document.add("torque_unit", tomlkit.item(m.torque_unit))
        document.add("position_unit", tomlkit.item(m.position_unit))
        if m.drive is not None:
            document.add("drive", tomlkit.item(m.drive))
        if m.own:
            document.add("formulas", _table({terms.name: terms.text for terms in m.own}))
        if m.constants:
            document.add("constants", _table({k: float(v) for k, v in m.constants.items()}))
        rows = tomlkit.table(is_super_table=True)
        own = {name for terms in m.own for name in terms.names}
        for p, value in zip(m.parameters, m.values, strict=True):
            bounds = m.bounds.get(p.name, (p.lower, p.upper) if p.name in own else None)
            if bounds == (-math.inf, math.inf):
                bounds = None
            row = {
                "value": float(value),
                "symbol": p.symbol,
                "unit": p.unit,
                "bounds": None if bounds is None else [float(x) for x in bounds],
                "stderr": self.stderr.get(p.name),
            }
            rows.add(p.name, _table({k: v for k, v in row.items() if v is not None}))
        document.add("parameters", rows)
        if self.fitted_on:
            document.add("fitted_on", _table(dict(self.fitted_on)))
        if m.box:
            document.add("box", _table({k: [float(a), float(b)] for k, (a, b) in m.box.items()}))

    def write(self, path: str | os.PathLike[str]) -> None:
        """Write the file whole or not at all."""
        unknown = [
            n for n, v in zip(self.model.names, self.model.values, strict=True)
            if not math.isfinite(v)
        ]  # fmt: skip
        if unknown:
            raise ModelFileError(
                f"{self.model.spec} has no value for {', '.join(unknown)}: fit it before saving"
            )
        write_whole(path, self.to_toml())


def write_whole(path: str | os.PathLike[str], text: str) -> None:
    """Write `text` to `path` so that a reader never sees half of it."""
    target = Path(path)
    try:
        handle, name = tempfile.mkstemp(dir=target.parent, prefix=f".{target.name}-")
        try:
            with os.fdopen(handle, "w", encoding="utf-8") as stream:
                stream.write(text)
            os.chmod(name, 0o644)
            os.replace(name, target)
        except BaseException:
            os.unlink(name)
            raise
    except OSError as error:
        raise ModelFileError(
            f"cannot write {target}: {error.strerror or error}; give a path in a folder that "
            f"exists and may be written to"
        ) from None


def _table(values: Mapping[str, Any]) -> Any:
    table = tomlkit.table()
    for key, value in values.items():
        table.add(key, tomlkit.item(value))
    return table


def read_model_file(path: str | os.PathLike[str]) -> ModelFile:
    """Read a model file; everything that is not understood is refused with its line.

    Raises
    ------
    ModelFileError
    """
    target = Path(path)
    try:
        text = target.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        reason = getattr(error, "strerror", None) or "it is not text"
        raise ModelFileError(f"cannot read the model file {target}: {reason}") from None
    return parse_model_file(text, target)


def parse_model_file(text: str, path: Path) -> ModelFile:
    """Read the text of a model file; `path` is where it is said to stand.

    Raises
    ------
    ModelFileError
    """
    try:
        data = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise ModelFileError(f"{path}: not a TOML file ({error})") from None
    return read_model(data, path, text)


def read_model(data: Mapping[str, Any], path: Path, text: str, *under: str) -> ModelFile:
    """The model of a file's parsed `data`, which `text` is the text of.

    Parameters
    ----------
    under
        Words after which `data` stands in the text, where the file holds more than one model.

    Raises
    ------
    ModelFileError
    """
    return _Reader(path, text, under).read(data)


def load(path: str | os.PathLike[str]) -> Model:
    """Read the model of a model file."""
    return read_model_file(path).model


class _Reader:
    """Reads one model; keeps the file's text to tell the line of what is wrong."""

    def __init__(self, path: Path, text: str, under: tuple[str, ...]) -> None:
        self.path = path
        self.text = text
        self.under = under

    def stop(self, what: str, *keys: str) -> ModelFileError:
        """An error that names the line on which the last of `keys` stands."""
        line = 0
        rows = self.text.splitlines()
        for key in (*self.under, *keys):
            for k in range(line, len(rows)):
                if key in rows[k]:
                    line = k
                    break
        where = f", line {line + 1}" if self.under or keys else ""
        return ModelFileError(f"{self.path}{where}: {what}")

    def read(self, data: Mapping[str, Any]) -> ModelFile:
        if data.get("kind") != "model":
            raise self.stop(
                f'this is not a model file: kind is {data.get("kind")!r}, "model" is needed',
                *(["kind"] if "kind" in data else []),
            )
        if data.get("schema") != SCHEMA:
            raise self.stop(
                f"schema {data.get('schema')!r} is not known here, {SCHEMA} is", "schema"
            )
        self._known(data, TOP_KEYS)
        if not isinstance(data.get("law"), str):
            raise self.stop("the key 'law' is missing, or not a name")
        for key in ("constants", "parameters", "fitted_on", "box", "formulas"):
            if not isinstance(data.get(key, {}), dict):
                raise self.stop(f"{key} is {data[key]!r}, a table is needed", key)
        self._known(data.get("box", {}), BOX_KEYS, "box]")
        try:
            own = self._formulas(data)
            if own and own[0].name == data["law"]:
                law, effects = data["law"], parse_effects(self._names(data, "effects"))
            else:
                law, effects = parse_spec("+".join([data["law"], *self._names(data, "effects")]))
            made = Model(
                law=law,
                effects=effects,
                own=own,
                constants=self._numbers(data.get("constants", {}), "constants"),
                rigid_body=self._names(data, "rigid_body"),
                torque_unit=self._choice(data, "torque_unit", ("N m", "N", "V", "%")),
                position_unit=self._choice(data, "position_unit", ("rad", "m")),
                drive=self._choice(data, "drive", ("voltage",)) if "drive" in data else None,
                box={k: self._pair(v, "box", k) for k, v in data.get("box", {}).items()},
            )
        except SpecError as error:
            formulas = data.get("formulas", {})
            wrong_law = data["law"] not in (*law_ids(), *formulas)
            raise self.stop(str(error), "law" if wrong_law else "effects") from None
        except KeyError as error:
            raise self.stop(f"the key {error} is missing") from None
        return self._with_parameters(made, data)

    def _formulas(self, data: Mapping[str, Any]) -> tuple[FormulaTerms, ...]:
        """Terms by formula, with what the rows of their parameters say about them."""
        made = []
        for name, text in data.get("formulas", {}).items():
            if not isinstance(text, str):
                raise self.stop(
                    f"{name} is {text!r}, a formula is needed", "formulas]", f"{name} ="
                )
            try:
                terms = FormulaTerms(name, text, effect=name != data["law"])
                said = zip(terms.symbols, terms.names, strict=True)
                declared = tuple((symbol, self._declaration(data, n)) for symbol, n in said)
                made.append(replace(terms, declared=declared))
                check_terms(terms)
            except SpecError as error:
                raise self.stop(str(error), "formulas]", f"{name} =") from None
        return tuple(made)

    def _declaration(self, data: Mapping[str, Any], name: str) -> Declaration:
        """Unit and bounds of a formula's parameter."""
        row = data.get("parameters", {}).get(name)
        if not isinstance(row, dict):
            return Declaration()
        unit = row.get("unit")
        bounds = (-math.inf, math.inf)
        if "bounds" in row:
            bounds = self._bounds(row["bounds"], f"parameters.{name}", "bounds")
        return Declaration(None if unit is None else str(unit), *bounds)

    def _with_parameters(self, made: Model, data: Mapping[str, Any]) -> ModelFile:
        rows = data.get("parameters", {})
        values, errors, bounds = [], {}, {}
        for name in rows:
            if name not in made.names:
                raise self.stop(
                    f"{made.spec} has no parameter {name!r}{nearest(name, made.names)}",
                    "parameters", name,
                )  # fmt: skip
        for p in made.parameters:
            row = rows.get(p.name)
            if not isinstance(row, dict) or "value" not in row:
                raise self.stop(f"parameter {p.name} of {made.spec} is missing")
            self._known(row, PARAMETER_KEYS, "parameters", p.name)
            values.append(self._number(row["value"], "parameters", f"parameters.{p.name}", "value"))
            if row.get("unit", p.unit) != p.unit:
                raise self.stop(
                    f"parameter {p.name} is in {p.unit}, not {row['unit']!r}",
                    f"parameters.{p.name}", "unit",
                )  # fmt: skip
            if "stderr" in row:
                errors[p.name] = self._number(row["stderr"], f"parameters.{p.name}", "stderr")
            if "bounds" in row:
                bounds[p.name] = self._bounds(row["bounds"], f"parameters.{p.name}", "bounds")
        # Equal bounds hold a parameter in every fit that follows.
        limits = {name: pair for name, pair in bounds.items() if pair[0] == pair[1]}
        fitted = data.get("fitted_on", {})
        self._known(fitted, FITTED_KEYS, "fitted_on")
        filled = replace(made, bounds=bounds, limits=limits).with_values(np.array(values))
        return ModelFile(filled, errors, fitted)

    def _names(self, data: Mapping[str, Any], key: str) -> tuple[str, ...]:
        value = data.get(key, [])
        if not isinstance(value, list) or not all(isinstance(name, str) for name in value):
            raise self.stop(f"{key} is {value!r}, a list of names is needed", key)
        return tuple(value)

    def _known(self, table: Mapping[str, Any], keys: set[str], *where: str) -> None:
        for key in table:
            if key not in keys:
                raise self.stop(
                    f"key {key!r} is unknown{nearest(key, tuple(sorted(keys)))}", *where, key
                )

    def _number(self, value: Any, *where: str) -> float:
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise self.stop(f"{where[-1]} is {value!r}, a number is needed", *where)
        if not math.isfinite(value):
            raise self.stop(f"{where[-1]} is {value}, a finite number is needed", *where)
        return float(value)

    def _numbers(self, table: Any, *where: str) -> dict[str, float]:
        return {key: self._number(value, *where, key) for key, value in table.items()}

    def _pair(self, value: Any, *where: str) -> tuple[float, float]:
        if not isinstance(value, list) or len(value) != 2:
            raise self.stop(f"{where[-1]} is {value!r}, two numbers are needed", *where)
        return self._number(value[0], *where), self._number(value[1], *where)

    def _bounds(self, value: Any, *where: str) -> tuple[float, float]:
        """Two numbers in order; infinite ones are no bounds."""
        if isinstance(value, list) and len(value) == 2:
            free = [isinstance(end, float) and math.isinf(end) for end in value]
            low, high = (
                end if open_end else self._number(end, *where)
                for end, open_end in zip(value, free, strict=True)
            )
            if low <= high:
                return low, high
        raise self.stop(f"{where[-1]} is {value!r}, two numbers in order are needed", *where)

    def _choice(self, data: Mapping[str, Any], key: str, options: tuple[str, ...]) -> str:
        value = str(data.get(key, options[0]))
        if value not in options:
            raise self.stop(f"{key} is {value!r}; known are {', '.join(options)}", key)
        return value
