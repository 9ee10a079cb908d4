"""Reading model files; everything that is not understood is refused with its line."""

from __future__ import annotations

import math
import os
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from stribeck.base.arguments import door
from stribeck.base.errors import ModelFileError, SpecError, StribeckError, nearest
from stribeck.base.toml import TomlText, read_text
from stribeck.models.catalog import constants_read, law_ids
from stribeck.models.fitted import FittedOn, note_origin
from stribeck.models.formula_law import Declaration, FormulaTerms, check_terms
from stribeck.models.model import Model
from stribeck.models.model_file import ModelFile
from stribeck.models.published.sets import PREFIX, published
from stribeck.models.spec import parse_effects, parse_spec
from stribeck.models.writer import SCHEMA

TOP_KEYS = (
    "kind",
    "schema",
    "law",
    "effects",
    "rigid_body",
    "torque_unit",
    "position_unit",
    "constants",
    "parameters",
    "fitted_on",
    "box",
    "drive",
    "formulas",
)
TABLES = ("constants", "parameters", "fitted_on", "box", "formulas")
PARAMETER_KEYS = ("value", "symbol", "unit", "bounds", "stderr", "per_run")
BOX_KEYS = (
    "velocity",
    "position",
    "acceleration",
    "temperature",
    "load_torque",
    "motor_torque",
    "external_torque",
)
FITTED_KEYS = ("path", "sha256", "files", "rows", "time_span", "rmse", "rmse_held_out")


@door(ModelFileError)
def read_model_file(path: str | os.PathLike[str]) -> ModelFile:
    """Read a model file; everything that is not understood is refused with its line.

    Parameters
    ----------
    path
        A file, or ``"published:ID"`` for a parameter set of the literature.

    Raises
    ------
    ModelFileError
        The file cannot be read, or holds something else than a model.
    SpecError
        There is no such published set.

    Examples
    --------
    >>> import stribeck as sb
    >>> sb.read_model_file("published:bam/mx64/bam_m1").model.spec
    'bam_m1'
    """
    target = Path(path)
    if str(path).startswith(PREFIX):
        return ModelFile(published(str(path)))
    try:
        return parse_model_file(read_text(target, "model file", ModelFileError), target)
    except ModelFileError as error:
        if target.suffix.casefold() == ".toml" or not target.exists():
            raise
        raise ModelFileError(
            f"{error}: a model file is TOML, as `stribeck fit -o FILE` writes it; what a recording "
            f"holds, `stribeck inspect` shows"
        ) from None


@door(ModelFileError)
def load(path: str | os.PathLike[str]) -> Model:
    """Read the model of a model file, or of ``"published:ID"``.

    Raises
    ------
    ModelFileError
        The file cannot be read, or holds something else than a model.

    Examples
    --------
    >>> import stribeck as sb
    >>> sb.load("published:bam/mx64/bam_m1").spec
    'bam_m1'
    """
    stored = read_model_file(path)
    note_origin(stored.model, stored.origin)
    return stored.model


def parse_model_file(text: str, path: Path) -> ModelFile:
    """Read the text of a model file; errors name `path`.

    Raises
    ------
    ModelFileError
        The text holds something else than a model.
    """
    source = TomlText(path, text, ModelFileError)
    return _Reader(source).read(source.parsed())


def read_model(data: Mapping[str, object], path: Path, text: str, *under: str) -> ModelFile:
    """The model in the parsed `data` of a file.

    Parameters
    ----------
    data
        The table that holds the model.
    path, text
        The file.
    under
        Words before `data` in the text, where the file holds more than one model.

    Raises
    ------
    ModelFileError
        The table holds something else than a model.
    """
    return _Reader(TomlText(path, text, ModelFileError, under)).read(data)


@dataclass(frozen=True)
class _Reader:
    """Reads one model from a table of a file."""

    source: TomlText

    def stop(self, what: str, *words: str) -> StribeckError:
        return self.source.stop(what, *words)

    def read(self, data: Mapping[str, object]) -> ModelFile:
        if data.get("kind") != "model":
            hint = "; robots have commands of their own: stribeck robot"
            raise self.stop(
                f'this is not a model file: kind is {data.get("kind")!r}, "model" is needed'
                + (hint if data.get("kind") == "robot" else ""),
                *(["kind"] if "kind" in data else []),
            )
        if data.get("schema") != SCHEMA:
            raise self.stop(
                f"schema {data.get('schema')!r} is not known here, {SCHEMA} is", "schema"
            )
        self.source.check_keys(data, TOP_KEYS)
        law = data.get("law")
        if not isinstance(law, str):
            raise self.stop("the key 'law' is missing, or not a name")
        tables = {key: self._table(data, key) for key in TABLES}
        self.source.check_keys(tables["box"], BOX_KEYS, "box]")
        try:
            made = self._model(law, data, tables)
        except SpecError as error:
            wrong_law = law not in (*law_ids(), *tables["formulas"])
            raise self.stop(str(error), "law" if wrong_law else "effects") from None
        made, moved = self._with_read_constants(made)
        return self._with_parameters(made, {**moved, **tables["parameters"]}, tables["fitted_on"])

    def _with_read_constants(self, made: Model) -> tuple[Model, dict[str, object]]:
        """The model with the constants that it reads, and rows of those that are parameters now.

        Earlier versions stored the exponent of m0 as a constant.
        """
        kept = constants_read(made.constants, made.law, made.effects)
        moved: dict[str, object] = {
            name: {"value": x} for name, x in made.constants.items() if name in made.names
        }
        for name in made.constants:
            if name not in kept and name not in moved:
                raise self.stop(
                    f"{made.spec} does not read the constant {name!r}: remove it",
                    "constants]",
                    name,
                )
        return replace(made, constants={n: x for n, x in kept.items() if n not in moved}), moved

    def _model(
        self, law: str, data: Mapping[str, object], tables: Mapping[str, Mapping[str, object]]
    ) -> Model:
        """The model without the values of its parameters."""
        own = self._formulas(law, tables["formulas"], tables["parameters"])
        if own and own[0].name == law:
            effects = parse_effects(self._names(data, "effects"))
        else:
            law, effects = parse_spec("+".join([law, *self._names(data, "effects")]))
        return Model(
            law=law,
            effects=effects,
            own=own,
            constants={
                name: self._number(value, "constants", name)
                for name, value in tables["constants"].items()
            },
            rigid_body=self._names(data, "rigid_body"),
            torque_unit=self._choice(data, "torque_unit", ("N m", "N", "V", "%")),
            position_unit=self._choice(data, "position_unit", ("rad", "m")),
            drive=self._choice(data, "drive", ("voltage",)) if "drive" in data else None,
            box={name: self._range(pair, "box]", name) for name, pair in tables["box"].items()},
        )

    def _formulas(
        self, law: str, formulas: Mapping[str, object], parameters: Mapping[str, object]
    ) -> tuple[FormulaTerms, ...]:
        """Terms by formula, with what the rows of their parameters state about them."""
        made = []
        for name, text in formulas.items():
            if not isinstance(text, str):
                raise self.stop(
                    f"{name} is {text!r}, a formula is needed", "formulas]", f"{name} ="
                )
            try:
                terms = FormulaTerms(name, text, effect=name != law)
                pairs = zip(terms.symbols, terms.names, strict=True)
                declared = tuple(
                    (symbol, self._declaration(parameters.get(n), n)) for symbol, n in pairs
                )
                made.append(replace(terms, declared=declared))
                check_terms(terms)
            except SpecError as error:
                raise self.stop(str(error), "formulas]", f"{name} =") from None
        return tuple(made)

    def _declaration(self, row: object, name: str) -> Declaration:
        """Unit and bounds of a formula's parameter."""
        if not isinstance(row, dict):
            return Declaration()
        unit = row.get("unit")
        bounds = (-math.inf, math.inf)
        if "bounds" in row:
            bounds = self._bounds(row["bounds"], f"parameters.{name}", "bounds")
        return Declaration(None if unit is None else str(unit), *bounds)

    def _with_parameters(
        self, made: Model, rows: Mapping[str, object], fitted: Mapping[str, object]
    ) -> ModelFile:
        values, errors, bounds = [], {}, {}
        per_run: dict[str, dict[str, tuple[float, float | None]]] = {}
        for name in rows:
            if name not in made.names:
                raise self.stop(
                    f"{made.spec} has no parameter {name!r}{nearest(name, made.names)}",
                    "parameters",
                    name,
                )
        for p in made.parameters:
            row, header = rows.get(p.name), f"parameters.{p.name}"
            if row is None:
                raise self.stop(f"parameter {p.name} of {made.spec} is missing")
            if not isinstance(row, dict) or "value" not in row:
                raise self.stop(
                    f"{p.name} is {row!r}: write {p.name} = {{ value = ... }}", "parameters", p.name
                )
            self.source.check_keys(row, PARAMETER_KEYS, "parameters", p.name)
            values.append(self._number(row["value"], "parameters", header, "value"))
            if row.get("unit", p.unit) != p.unit:
                raise self.stop(
                    f"parameter {p.name} is in {p.unit}, not {row['unit']!r}", header, "unit"
                )
            if "stderr" in row:
                errors[p.name] = self._number(row["stderr"], header, "stderr")
                if errors[p.name] < 0.0:
                    raise self.stop(f"stderr is {errors[p.name]}, below zero", header, "stderr")
            if "bounds" in row:
                low, high = bounds[p.name] = self._bounds(row["bounds"], header, "bounds")
                if not low <= values[-1] <= high:
                    raise self.stop(
                        f"{p.name} = {values[-1]:g} is not between its bounds, {low:g} and "
                        f"{high:g}: correct one of them",
                        header,
                        "bounds",
                    )
            if "per_run" in row:
                per_run[p.name] = self._of_runs(row["per_run"], f"{header}.per_run]")
        # Equal bounds hold a parameter in every fit that follows.
        limits = {name: pair for name, pair in bounds.items() if pair[0] == pair[1]}
        filled = replace(made, bounds=bounds, limits=limits).with_values(np.array(values))
        return ModelFile(filled, errors, self._fitted_on(fitted), per_run)

    def _of_runs(self, table: object, header: str) -> dict[str, tuple[float, float | None]]:
        """Value and standard error of a parameter in each run."""
        if not isinstance(table, dict):
            raise self.stop(f"per_run is {table!r}, a table of runs is needed", header)
        made: dict[str, tuple[float, float | None]] = {}
        for run, row in table.items():
            if not isinstance(row, dict) or "value" not in row or set(row) - {"value", "stderr"}:
                raise self.stop(
                    f"run {run!r} is {row!r}, {{ value = ..., stderr = ... }} is needed", header
                )
            error = self._number(row["stderr"], header, run) if "stderr" in row else None
            made[run] = self._number(row["value"], header, run), error
        return made

    def _fitted_on(self, table: Mapping[str, object]) -> FittedOn:
        self.source.check_keys(table, FITTED_KEYS, "fitted_on")
        read: FittedOn = {}
        # In the order of the file, in which it is written again.
        for key, value in table.items():
            match key:
                case "path" | "sha256":
                    read[key] = self._text(value, "fitted_on]", key)
                case "files":
                    read[key] = list(self._names(table, key))
                case "rows":
                    read[key] = self._whole(value, "fitted_on]", key)
                case "time_span":
                    read[key] = list(self._pair(value, "fitted_on]", key))
                case "rmse" | "rmse_held_out":
                    read[key] = self._real(value, "fitted_on]", key)
        return read

    def _table(self, data: Mapping[str, object], key: str) -> Mapping[str, object]:
        value = data.get(key, {})
        if not isinstance(value, dict):
            raise self.stop(f"{key} is {value!r}, a table is needed", key)
        return value

    def _names(self, data: Mapping[str, object], key: str) -> tuple[str, ...]:
        value = data.get(key, [])
        if not isinstance(value, list) or not all(isinstance(name, str) for name in value):
            raise self.stop(f"{key} is {value!r}, a list of names is needed", key)
        return tuple(value)

    def _text(self, value: object, *where: str) -> str:
        if not isinstance(value, str):
            raise self.stop(f"{where[-1]} is {value!r}, a text is needed", *where)
        return value

    def _whole(self, value: object, *where: str) -> int:
        if isinstance(value, bool) or not isinstance(value, int):
            raise self.stop(f"{where[-1]} is {value!r}, a whole number is needed", *where)
        return value

    def _real(self, value: object, *where: str) -> float:
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise self.stop(f"{where[-1]} is {value!r}, a number is needed", *where)
        return float(value)

    def _number(self, value: object, *where: str) -> float:
        number = self._real(value, *where)
        if not math.isfinite(number):
            raise self.stop(f"{where[-1]} is {value}, a finite number is needed", *where)
        return number

    def _pair(self, value: object, *where: str) -> tuple[float, float]:
        if not isinstance(value, list) or len(value) != 2:
            raise self.stop(f"{where[-1]} is {value!r}, two numbers are needed", *where)
        return self._number(value[0], *where), self._number(value[1], *where)

    def _range(self, value: object, *where: str) -> tuple[float, float]:
        low, high = self._pair(value, *where)
        if low > high:
            raise self.stop(f"{where[-1]} is {value!r}: give the lower end first", *where)
        return low, high

    def _bounds(self, value: object, *where: str) -> tuple[float, float]:
        """Two numbers in order; an infinite one is no bound."""
        if isinstance(value, list) and len(value) == 2:
            low, high = (
                end if isinstance(end, float) and math.isinf(end) else self._number(end, *where)
                for end in value
            )
            if low <= high:
                return low, high
        raise self.stop(f"{where[-1]} is {value!r}, two numbers in order are needed", *where)

    def _choice(self, data: Mapping[str, object], key: str, options: tuple[str, ...]) -> str:
        value = str(data.get(key, options[0]))
        if value not in options:
            raise self.stop(f"{key} is {value!r}; known are {', '.join(options)}", key)
        return value
