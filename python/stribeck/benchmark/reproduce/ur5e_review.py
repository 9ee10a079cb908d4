"""The UR5e review 2024/25: tables 4 to 7 and figures 3 to 15, for joint 1."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from stribeck.base.errors import FitError
from stribeck.benchmark.reproduce import ur5e_data as data
from stribeck.benchmark.reproduce import ur5e_figures as draw
from stribeck.benchmark.reproduce.result import Reproduction, Row, last_digit
from stribeck.benchmark.reproduce.ur5e_arm import ARMS, EFFORT, STARTS, arm_rows
from stribeck.benchmark.reproduce.ur5e_tables import (
    TABLE_5,
    TABLES,
    TADESE,
    Errors,
    Table,
)
from stribeck.fitting.evaluate import evaluate
from stribeck.fitting.fit import fit
from stribeck.fitting.result import Fit
from stribeck.identify.figures import rms
from stribeck.models.published.sets import published_set
from stribeck.recording.recording import Recording

Array = NDArray[np.float64]

#: Draws of the way points. The first start of each fit is the printed set.
DRAWS = 6
#: Laws of a quick run.
QUICK = ("coulomb", "gaz_a", "li", "lugre")


@dataclass(frozen=True)
class Fitted:
    """A law on the data of a table: its errors over all samples, array [n]."""

    law: str
    fit: Fit
    error: Array


def reproduce(seed: int = 0, quick: bool = False) -> Reproduction:
    """Fit the laws of tables 4 to 6 to joint 1, recover table 7, and draw the figures."""
    chosen = [_only(table, QUICK) if quick else table for table in TABLES]
    draws = [seed + k for k in range(2 if quick else DRAWS)]
    fitted = {t.number: [_fit_table(t, draw) for draw in draws] for t in chosen}
    warm = data.motion(2, seed, warming=True)
    rows = [row for t in chosen for row in _error_rows(t, fitted[t.number])]
    if not quick:
        rows += _line_rows("table 6", "tadese_t", TADESE, _tadese(draws))
    rows += arm_rows(chosen[:1] if quick else chosen, seed, 2 if quick else ARMS)
    rows += [row for t in chosen for row in _energy_rows(t)]
    for t in chosen:
        for law, line in t.lines.items():
            rows += _parameter_rows(law, t, line.std, seed)
    if not quick:
        rows += _parameter_rows("tadese_t", TABLE_5, TADESE.std, seed)
    first = {number: every[0] for number, every in fitted.items()}
    return Reproduction(
        paper="ur5e_review",
        title="Static and dynamic friction models for robotic manipulators",
        source="the review of 25 friction models on a UR5e, 2024/25",
        data=_DATA,
        left_out=_LEFT_OUT,
        rows=tuple(rows),
        pictures=(
            *draw.motions(seed),
            draw.velocity_laws(first[4]),
            *(draw.boxes(t.number, first[t.number]) for t in chosen),
            *draw.warm_laws(warm, first[5]),
            *draw.hysteresis(first[6]),
        ),
    )


_DATA = (
    "The paper publishes no measurements. Joint 1 is simulated with the law that has the smallest "
    "error of its table, with the parameters of table 7: gaz_a for table 4, li for table 5, lugre "
    "for table 6; noise has the standard deviation that the table prints for that law.",
    "Way points are random, as the review's are: trapezoidal profiles (Test 1) or polynomials of "
    f"fifth degree for 60 s (Test 2), {data.RATE:g} Hz. Table 5 uses {len(data.CYCLES)} of 90 "
    f"cycles at {data.THIN_RATE:g} Hz, from {data.COLD:g} to {data.WARM:g} degC.",
    "Each law is fitted from its printed parameters and from one more start, over all samples as "
    "in the review. Six draws of way points show how far they move an error.",
    "Joint 2, the energies of tables 4 to 6, and figures 3 to 5, 8 and 9 are those of the "
    "synthetic arms of stribeck generate, with the kinematics and masses of a UR5e, motor "
    "constants of the usual size and friction outside the catalog; several arms show how far "
    "errors scatter.",
)
_LEFT_OUT = (
    "tables 4 to 6, energies in J: those of a robot whose motor constants the review does not "
    "print; their arithmetic is checked, and the percentages are compared",
    "figures 6, 7 and 10 to 15, joints 2 to 6: their parameters are not printed",
    "figures 1 and 2: a drawing and a photograph",
)


def _only(table: Table, laws: Iterable[str]) -> Table:
    return replace(table, lines={law: row for law, row in table.lines.items() if law in laws})


def _recording(table: Table, law: str, noise: float, seed: int) -> Recording:
    """Joint 1 of a table with the friction of a law, and noise of this RMS [N m]."""
    motion = data.motion(table.test, seed, warming=table.number == TABLE_5.number)
    friction = motion.friction(published_set(f"ur5e_review/table_7/joint_1/{law}").model)
    return motion.recording(friction, noise, seed)


def _true_recording(table: Table, seed: int) -> Recording:
    """Joint 1 with the law of the smallest error and the noise that is printed for it."""
    return _recording(table, table.truth, table.lines[table.truth].std, seed)


def _fit_law(law: str, recording: Recording) -> Fitted:
    printed = published_set(f"ur5e_review/table_7/joint_1/{law}").model
    # A parameter that the motion does not determine has no finite variance, which is told as such.
    with np.errstate(over="ignore", invalid="ignore"):
        made = fit(printed, recording, starts=STARTS, effort=EFFORT)
    return Fitted(law, made, recording.torque - made.prediction)


def _fit_table(table: Table, seed: int) -> list[Fitted]:
    recording = _true_recording(table, seed)
    return [_fit_law(law, recording) for law in table.lines]


def _tadese(draws: Sequence[int]) -> list[Fitted]:
    """Tadese's law, which the review fits to the data of table 5.

    Its dry friction may vanish at low speed, where no bristle holds: such a fit is refused, and the
    draw does not count.
    """
    found = []
    for seed in draws:
        with suppress(FitError):
            found.append(_fit_law("tadese_t", _true_recording(TABLE_5, seed)))
    return found


def _error_rows(table: Table, draws: Sequence[Sequence[Fitted]]) -> Iterable[Row]:
    where = f"table {table.number}"
    for k, (law, line) in enumerate(table.lines.items()):
        yield from _line_rows(where, law, line, [each[k] for each in draws])


def _line_rows(where: str, law: str, line: Errors, found: Sequence[Fitted]) -> list[Row]:
    """Mean and standard deviation of joint 1."""
    why = (
        "mean over the draws of way points; three times their scatter, and half a unit of the last "
        "digit. What the true friction has beyond the law that stands in for it is missing"
    )
    rows = []
    for name, paper, ours in (
        ("mean", line.mean, np.array([f.error.mean() for f in found])),
        ("std", line.std, np.array([f.error.std() for f in found])),
    ):
        allowed = 3.0 * float(ours.std(ddof=1)) + 0.005
        rows.append(Row(where, f"{law}, {name}", "N m", paper, float(ours.mean()), allowed, why))
    return rows


def _energy_rows(table: Table) -> Iterable[Row]:
    """The arithmetic of the printed energies, eq 11."""
    measured = table.measured_energy
    rounding = 0.5 * 10.0**-table.decimals
    for law, line in table.lines.items():
        yield Row(
            f"table {table.number}",
            f"{law}, energy error",
            "J",
            line.energy_error,
            measured - line.energy,
            2.0 * rounding + 0.005,
            "rounding of the two printed energies and of their difference",
        )
        yield Row(
            f"table {table.number}",
            f"{law}, in per cent",
            "%",
            line.percent,
            100.0 * line.energy_error / measured,
            0.005 * (1.0 + 100.0 / measured) + abs(line.percent) * rounding / measured,
            "rounding of the percentage and of the energies",
        )


def _parameter_rows(law: str, table: Table, noise: float, seed: int) -> Iterable[Row]:
    """Table 7: a law's parameters from data that were made with them, and its curve."""
    source = published_set(f"ur5e_review/table_7/joint_1/{law}")
    recording = _recording(table, law, noise, seed)
    made = _fit_law(law, recording).fit
    why = (
        "three standard errors of a fit to data made with the printed set and noise of the table's "
        "standard deviation, and the last digit; a parameter without a standard error is not "
        "determined by the motion and is allowed the last digit alone"
    )
    names = {p.symbol: p.name for p in made.model.parameters}
    for symbol, printed in source.printed.items():
        name = names[symbol]
        paper = source.model.value(name)
        estimate = made.estimates[name]
        allowed = 3.0 * (estimate.stderr or 0.0) + last_digit(str(printed))
        yield Row("table 7", f"{law}, {symbol}", estimate.unit, paper, estimate.value, allowed, why)
    true = evaluate(source.model, recording).prediction
    # The squared error of a fitted curve is the noise's times parameters over samples.
    expected = noise * np.sqrt(len(names) / recording.rows)
    yield Row(
        "table 7",
        f"{law}, refit minus print, RMS",
        "N m",
        0.0,
        rms(made.prediction - true),
        2.0 * float(expected),
        "twice what noise does to a curve with as many parameters: it shows that parameters which "
        "miss lie on a ridge, along which the friction is the same",
        "at most",
    )
