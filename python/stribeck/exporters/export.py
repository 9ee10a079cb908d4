"""Export of a model as a program for a controller."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Literal, get_args

from stribeck.base.arguments import door
from stribeck.base.errors import ModelFileError, SpecError, option
from stribeck.base.shown import Shown
from stribeck.exporters.about import About
from stribeck.exporters.c.files import c_files, identifier
from stribeck.exporters.document import json_files
from stribeck.exporters.fixed.files import analyse, fixed_files
from stribeck.exporters.mujoco import mujoco_files
from stribeck.exporters.precision import FIXED, FLOATING, FixedPrecision, Precision
from stribeck.exporters.program import Program
from stribeck.exporters.rust.files import rust_files
from stribeck.exporters.vectors import vectors
from stribeck.exporters.written import chosen, write_files
from stribeck.fitting.result import Fit
from stribeck.models.fitted import FittedOn
from stribeck.models.model import Model
from stribeck.models.model_file import WITH_MODEL, ModelFile
from stribeck.passivity.operating_box import refuse_unread_sides

Language = Literal["c", "rust", "mujoco", "json"]


@dataclass(frozen=True, repr=False)
class Export(Shown):
    """What was written.

    Attributes
    ----------
    model
        The exported part: the friction, and rigid-body terms that were identified with it.
    passive
        Whether it is passive over its operating box; None where that is unknown.
    files
        The files that were written.

    Examples
    --------
    >>> import stribeck as sb, tempfile
    >>> friction = sb.model("coulomb", coulomb_friction=2.0, viscous_friction=0.5)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     written = sb.export(friction, "rust", folder, box={"velocity": (-3.0, 3.0)})
    >>> [path.name for path in written.files], written.passive
    (['coulomb.rs'], True)
    """

    model: Model
    language: Language
    precision: Precision | FixedPrecision
    passive: bool | None
    files: tuple[Path, ...]

    def to_dict(self) -> dict[str, object]:
        """As JSON."""
        return {
            "model": self.model.spec,
            "to": self.language,
            "precision": self.precision,
            "passive": self.passive,
            "files": [str(path) for path in self.files],
        }


@door(ModelFileError, model=WITH_MODEL)
def export(
    model: Model | ModelFile | Fit,
    to: str,
    folder: str | os.PathLike[str],
    *,
    name: str | None = None,
    precision: str = "f64",
    libm: bool = False,
    box: Mapping[str, tuple[float, float]] | None = None,
    seed: int = 0,
) -> Export:
    """Write a model as a program for a controller, with test vectors and a self-test.

    One step of the model is written with the operations of the core, so that C, crate and Python
    give the same bits.

    Parameters
    ----------
    model : Model, ModelFile or Fit
        With values for all parameters. A delay, which belongs to the recording, is left out.
    to : {"c", "rust", "mujoco", "json"}
        C99 without libraries, a Rust module for the crate, MJCF with the Coulomb and viscous
        friction of a joint, or the operations of the step as data.
    folder
        Folder of the files, created if needed. Files with the same names are replaced.
    name
        Start of the names of files, types and functions. [default: the model's spec]
    precision : {"f64", "f32", "q31", "q15"}
        Number format of a program. In fixed point, for models without memory only, the header
        states a bound of the torque's error over the operating box.
    libm
        In C, use the platform's ``math.h``: smaller, but the bits are the platform's.
    box : dict of (low, high)
        Operating box in SI units and degC, for certificate and test vectors. Default: the model's.
    seed
        Seed of the test vectors.

    Returns
    -------
    Export

    Raises
    ------
    SpecError
        A format that is unknown, or a parameter without a value.
    ModelFileError
        The folder cannot be written to.

    Examples
    --------
    >>> import stribeck as sb, tempfile
    >>> friction = sb.model("coulomb", coulomb_friction=2.0, viscous_friction=0.5)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     written = export(friction, "c", folder, box={"velocity": (-3.0, 3.0)})
    ...     [path.name for path in written.files], written.passive
    (['coulomb.h', 'coulomb.c', 'coulomb_vectors.h', 'coulomb_test.c'], True)
    """
    asked = model if isinstance(model, Model) else model.model
    asked.known_values()
    refuse_unread_sides(box or {}, asked.spec, asked.friction.core.needs)
    about = About.of(asked.friction, _provenance(model), box or {})
    return _export(about, to, precision, Path(folder), name, libm, box or {}, seed)


def _export(
    about: About,
    to: str,
    precision: str,
    folder: Path,
    name: str | None,
    libm: bool,
    box: Mapping[str, tuple[float, float]],
    seed: int,
) -> Export:
    language: Language = chosen("to", to, get_args(Language))
    form: Precision | FixedPrecision = chosen("precision", precision, (*FLOATING, *FIXED))
    if libm and (language != "c" or form in FIXED):
        raise SpecError(
            f"libm is for C in floating point: leave it out, or give {option('to', 'c')}"
        )
    called = identifier(name or about.model.spec)
    texts = _texts(about, language, form, called, libm, box, seed)
    certificate = about.certificate
    return Export(
        model=about.model,
        language=language,
        precision=form,
        passive=None if certificate is None else certificate.passive,
        files=write_files(texts, folder),
    )


def _texts(
    about: About,
    language: Language,
    form: Precision | FixedPrecision,
    name: str,
    libm: bool,
    box: Mapping[str, tuple[float, float]],
    seed: int,
) -> Mapping[str, str]:
    if language == "mujoco":
        if form != "f64":
            raise SpecError(f"MJCF has no number format: leave {option('precision', form)} out")
        return mujoco_files(about, name=name)
    if form == "q31" or form == "q15":
        if language != "c":
            raise SpecError(
                f"{form} is for C only: give {option('to', 'c')}, or {option('precision', 'f32')}"
            )
        analysis = analyse(about, Program.of(about.model), box, form)
        return fixed_files(about, analysis, name=name, precision=form, seed=seed)
    program = Program.of(about.model, "single" if form == "f32" else "double")
    rows = vectors(about.model, program, box, form, seed=seed)
    match language:
        case "c":
            return c_files(about, program, rows, name=name, precision=form, libm=libm)
        case "rust":
            return rust_files(about, program, rows, name=name, precision=form)
        case "json":
            return json_files(about, program, name=name, precision=form)


def _provenance(model: Model | ModelFile | Fit) -> FittedOn:
    match model:
        case Model():
            return {}
        case ModelFile():
            return model.fitted_on
    return ModelFile.of(model).fitted_on
