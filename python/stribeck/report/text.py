"""What the commands print: results at a glance, in plain words with units.

Every function takes a result and returns text of at most `WIDTH` columns.
"""

from __future__ import annotations

import math
import textwrap
from collections.abc import Collection, Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from stribeck.effect.describe import physically
from stribeck.identify.figures import torque_cutoff
from stribeck.report.numbers import (
    DASH,
    MINUS,
    change_text,
    confidence_words,
    listed,
    percent,
    plain,
    thousands,
    with_error,
)

if TYPE_CHECKING:
    from stribeck.diagnosis.bound import Explainable
    from stribeck.diagnosis.compare import Assessment, Comparison
    from stribeck.diagnosis.floor import NoiseFloor
    from stribeck.diagnosis.improve import Addition, Improvement
    from stribeck.diagnosis.inspect import Inspection
    from stribeck.diagnosis.result import Diagnosis, Finding
    from stribeck.diagnosis.testable import Untestable
    from stribeck.diagnosis.unexplained import Unexplained
    from stribeck.diagnosis.visibility import Group, SmallestVisible
    from stribeck.fitting.result import Fit
    from stribeck.identify.estimates import Estimate
    from stribeck.models.model import Model
    from stribeck.recording.recording import Recording

WIDTH = 98
BAR = 40
EIGHTHS = " ▏▎▍▌▋▊▉█"

#: Names of the regimes as people say them.
REGIMES = {
    "reversal": "within 0.2 s of a reversal",
    "low_speed": "slowest quarter of the speeds",
    "high_speed": "fastest quarter of the speeds",
    "forward": "moving forward (v > 0)",
    "backward": "moving backward (v < 0)",
    "motoring": "motor drives (torque along v)",
    "generating": "motor brakes (torque against v)",
    "cold": "coldest quarter",
    "hot": "warmest quarter",
    "start": "first quarter of the time",
    "end": "last quarter of the time",
    "drive_on": "drive on",
    "drive_off": "drive off",
    "standstill": "at rest (not scored)",
}

STOPPED = {
    "noise_floor": "What is left is noise: no structure above the noise floor.",
    "nothing_passes": "Stopped: no further effect passes the test on data it has not seen.",
    "max_steps": "Stopped at the largest number of steps allowed; more effects may be missing.",
}

#: An error of all rows within this ratio of the noise floor is at it; a held-out error from this
#: ratio of it on is larger.
AT_THE_NOISE, FORETOLD = 1.05, 1.1

PASSIVITY = {
    True: "Passive: proved that this friction gives off no energy over the ranges seen.",
    False: "Not passive: somewhere in the ranges seen this friction gives off energy (stribeck "
    "check shows where).",
    None: "Whether this friction gives off energy over the ranges seen cannot be decided.",
}


def paragraph(text: str, indent: int = 2, hang: int = 0) -> str:
    """`text` wrapped to the width, each line indented."""
    first = " " * indent
    return textwrap.fill(
        text, WIDTH, initial_indent=first, subsequent_indent=first + " " * hang,
        break_long_words=False, break_on_hyphens=False,
    )  # fmt: skip


def table(rows: Sequence[Sequence[str]], right: Collection[int] = (), indent: int = 2) -> str:
    """Columns lined up; the first row is the heading, columns in `right` are set flush right."""
    widths = [max(len(row[k]) for row in rows) for k in range(len(rows[0]))]
    lines = []
    for row in rows:
        cells = [
            cell.rjust(width) if k in right else cell.ljust(width)
            for k, (cell, width) in enumerate(zip(row, widths, strict=True))
        ]
        lines.append(" " * indent + "  ".join(cells).rstrip())
    rule = " " * indent + "─" * (sum(widths) + 2 * (len(widths) - 1))
    return "\n".join([lines[0], rule, *lines[1:]])


def bar(value: float, largest: float, floor: float | None) -> str:
    """A bar of `value`: the noise floor's part shaded, the rest solid."""
    if not (math.isfinite(value) and largest > 0):
        return ""
    length = BAR * value / largest
    shaded = 0 if floor is None else round(BAR * min(floor, value) / largest)
    whole = int(length)
    rest = EIGHTHS[int(8 * (length - whole))].strip() if whole >= shaded else ""
    return "▒" * shaded + "█" * max(whole - shaded, 0) + rest


def bars(
    labels: Sequence[str], values: Sequence[float | None], floor: float | None, unit: str
) -> str:
    """One bar a step, with the error, and how much it fell."""
    known = [v for v in values if v is not None]
    largest = max([*known, floor or 0.0], default=0.0)
    wide = max(len(label) for label in labels)
    lines, before = [], None
    for label, value in zip(labels, values, strict=True):
        if value is None:
            lines.append(f"  {label:<{wide}}  (no held-out figure)")
            continue
        change = ""
        if before:
            change = f"  {change_text(before, value)}"
        shape = bar(value, largest, floor)
        lines.append(f"  {label:<{wide}}  {shape:<{BAR}}  {plain(value)} {unit}{change}")
        before = value
    if floor is not None:
        lines.append(f"  {'':<{wide}}  ▒ noise floor, {plain(floor)} {unit}   █ error above it")
    return "\n".join(lines)


def file_name(recording: Recording) -> str:
    """The recording's file, and its joint where it has a name."""
    name = Path(recording.path).name
    return f"{name}, joint {recording.joint}" if recording.joint else name


def scored_sentence(r: Recording) -> str:
    """Which rows count, in one sentence."""
    scored = r.scored()
    if r.velocity_threshold == 0.0:
        return f"All {thousands(r.time.size)} rows count, moving or not."
    return (
        f"{thousands(int(scored['rows']))} of {thousands(r.time.size)} rows count "
        f"({percent(scored['share'])}): those moving faster than "
        f"{plain(r.velocity_threshold, 2)} {r.position_unit}/s, five times the noise of the "
        f"velocity."
    )


def held_out_meaning(r: Recording) -> str:
    """What "held out" means on this recording."""
    pieces = (
        "run" if r.runs >= 5 and r.block_count == r.runs
        else "tenth of the recording" if r.block_count == 10
        else f"of {r.block_count} blocks"
    )  # fmt: skip
    return f"each {pieces} predicted by a refit that never saw it"


def _flags(e: Estimate) -> str:
    flags = []
    if e.held:
        return "held"
    if not e.identifiable:
        flags.append("not identifiable on this data")
    if e.at_bound:
        if e.value <= e.lower + 0.5 * (e.upper - e.lower):
            flags.append("zero: not needed here" if e.value == 0.0 else "at its lower bound")
        else:
            flags.append("at its upper bound")
    if e.stderr is not None and e.value != 0.0 and e.identifiable and not e.at_bound:
        if e.stderr > 0.5 * abs(e.value):
            flags.append("hardly determined")
    return "; ".join(flags)


def unit_text(unit: str) -> str:
    """A unit, or a dash for a pure number: a lone 1 reads like a value."""
    return DASH if unit == "1" else unit


def parameter_rows(estimates: Iterable[Estimate]) -> list[list[str]]:
    """One row a parameter: name, symbol, value, error, unit, relative error, flags."""
    rows = []
    for e in estimates:
        value, error = with_error(e.value, e.stderr)
        relative = (
            percent(e.stderr / abs(e.value)) if e.stderr is not None and e.value != 0.0 else ""
        )
        rows.append(
            [
                e.name,
                e.symbol,
                value,
                f"± {error}" if error else "",
                unit_text(e.unit),
                relative,
                _flags(e),
            ]
        )
    return rows


def parameters_text(estimates: Mapping[str, Estimate]) -> str:
    """The table of parameters and what its errors mean."""
    heading = ["parameter", "symbol", "value", "error", "unit", "relative", ""]
    rows = [heading, *parameter_rows(estimates.values())]
    wide = table(rows, right=(2, 5))
    if max(map(len, wide.splitlines())) > WIDTH:
        wide = table([[*row[:1], *row[2:]] for row in rows], right=(1, 4))
    return wide


def _errors_text(f: Fit) -> str:
    unit, r = f.model.torque_unit, f.recording
    meaning = "root mean square over the rows that count"
    rows = [("error (RMSE)", f"{plain(f.rmse)} {unit}", meaning)]
    if f.rmse_held_out is not None:
        rows.append(("held-out error", f"{plain(f.rmse_held_out)} {unit}", held_out_meaning(r)))
    if f.relative_residual is not None:
        cutoff = torque_cutoff(r)
        below = f", both below {cutoff:.3g} Hz" if cutoff else ""
        rows.append(
            ("relative residual", percent(f.relative_residual), f"held-out error / torque{below}")
        )
    first, second = max(len(a) for a, _, _ in rows), max(len(b) for _, b, _ in rows)
    return "\n".join(f"  {a:<{first}}  {b:>{second}}  {c}" for a, b, c in rows)


def notes_text(*groups: Iterable[str]) -> str:
    """Notes, each once."""
    notes = list(dict.fromkeys(note for group in groups for note in group))
    return "\n".join(paragraph(f"note: {note}", 2, 6) for note in notes)


def _joined(*parts: str) -> str:
    return "\n\n".join(part for part in parts if part)


def model_text(model: Model) -> str:
    """A model's parameters and where it has been seen."""
    rows = [["parameter", "symbol", "value", "unit", "what it is"]]
    for p, value in zip(model.parameters, model.values, strict=True):
        shown = plain(float(value), 4) if np.isfinite(value) else "not fitted"
        rows.append([p.name, p.symbol, shown, unit_text(p.unit), p.description.rstrip(".")])
    room = WIDTH - 2 - sum(max(len(row[k]) for row in rows) + 2 for k in range(4))
    rows = [[*row[:4], textwrap.shorten(row[4], max(room, 12), placeholder=" …")] for row in rows]
    units = {
        "velocity": f"{model.position_unit}/s",
        "position": model.position_unit,
        "acceleration": f"{model.position_unit}/s2",
        "temperature": "degC",
        "load_torque": model.load_unit,
    }
    box = "; ".join(
        f"{name} {plain(a)} to {plain(b)} {units.get(name, '')}"
        for name, (a, b) in model.box.items()
    )
    return _joined(
        f"model {model.spec}",
        table(rows, right=(2,)),
        paragraph(f"Seen at: {box}", 2, 2) if box else "",
    )


def fit_text(fit: Fit) -> str:
    """A fit at a glance."""
    r = fit.recording
    refitted = fit.starts > 0
    head = f"{fit.model.spec} {'fitted to' if refitted else 'evaluated on'} {file_name(r)}"
    legend = ""
    if any(e.stderr is not None for e in fit.estimates.values()):
        assumed = (
            "if every row errs for itself" if fit.errors == "independent"
            else "allowing for noise that is correlated in time"
        )  # fmt: skip
        legend = paragraph(
            f"± is one standard error, {assumed}; it knows nothing of effects the model lacks."
        )
    trouble = (
        "" if fit.converged else paragraph(f"The search did not converge ({fit.outcome}).", 2, 2)
    )
    search = (
        f"{fit.starts} start{'s' if fit.starts > 1 else ''}, {fit.evaluations} evaluations, "
        f"{fit.seconds:.1f} s; {scored_sentence(r)}"
    )
    return _joined(
        head,
        paragraph(search, 2) if refitted else paragraph(scored_sentence(r)),
        parameters_text(fit.estimates) + ("\n" + legend if legend else ""),
        "\n".join(
            paragraph(f"{name} is not identifiable: {e.why}.", 2, 2)
            for name, e in fit.estimates.items()
            if e.why is not None
        ),
        _errors_text(fit),
        paragraph(PASSIVITY[fit.passive()] + cost_sentence(fit)),
        trouble,
        notes_text(r.notes, fit.notes),
    )


def cost_sentence(fit: Fit) -> str:
    """What passivity costs, where it was asked for; with a space before it."""
    cost = fit.passive_cost
    if cost is None:
        return ""
    if not cost.imposed:
        return " It costs nothing: the best fit is passive by itself."
    change = change_text(cost.rmse_free, fit.rmse)
    unit = fit.model.torque_unit
    sentence = (
        f" Held at {cost.conditions} operating points and cycles, with which the error (RMSE) goes "
        f"from {plain(cost.rmse_free)} to {plain(fit.rmse)} {unit} ({change})"
    )
    if cost.rmse_held_out_free is None or fit.rmse_held_out is None:
        return sentence + "."
    held_out = f"{plain(cost.rmse_held_out_free)} to {plain(fit.rmse_held_out)} {unit}"
    return f"{sentence}, held out from {held_out}."


def worst_places(assessment: Assessment, most: int = 3) -> list[str]:
    """The regimes where a model errs most, as sentences."""
    unit = assessment.fit.model.torque_unit
    rows = [
        g for g in assessment.regimes
        if g.regime != "standstill" and g.share > 0.005 and g.rmse > 1.15 * assessment.rmse
    ]  # fmt: skip
    rows.sort(key=lambda g: -g.rmse)
    return [
        f"{REGIMES[g.regime]}: error {plain(g.rmse)} {unit}, "
        f"{g.rmse / assessment.rmse:.1f} times its average"
        + (
            f"; measured is {'above' if g.bias > 0 else 'below'} the model by "
            f"{plain(abs(g.bias))} {unit} on average"
            if abs(g.bias) > 0.3 * g.rmse else ""
        )
        for g in rows[:most]
    ]  # fmt: skip


def comparison_text(comparison: Comparison) -> str:
    """Models side by side, and where each fails."""
    r, unit = comparison.recording, comparison.recording.torque_unit
    models = comparison.models
    heading = ["model", f"RMSE [{unit}]", "held-out", "rel. residual", "R²", "mean error"]
    with_energy = any(a.energy is not None for a in models)
    if with_energy:
        heading.append("energy error")
    rows = [heading]
    for a in models:
        row = [
            a.model,
            plain(a.rmse),
            "same file" if a.rmse_held_out is None else plain(a.rmse_held_out),
            "" if a.relative_residual is None else percent(a.relative_residual),
            f"{a.r2:.4f}",
            _signed(a.mean, a.rmse),
        ]
        if with_energy:
            error = a.energy["error_percent"] if a.energy else math.nan
            row.append(f"{error:+.1f} %" if math.isfinite(error) else "")
        rows.append(row)
    overview = table(rows, right=range(1, len(heading)))
    if max(map(len, overview.splitlines())) > WIDTH:
        # Long specs: number the models in the tables, and say below which is which.
        names = {a.model: f"[{k}]" for k, a in enumerate(models, 1)}
        overview = table(
            [heading, *[[names[row[0]], *row[1:]] for row in rows[1:]]],
            right=range(1, len(heading)),
        )
        overview += "\n\n" + "\n".join(f"  {tag} {name}" for name, tag in names.items())
    floor = (
        f"noise floor {plain(comparison.noise_floor)} {unit}: the error that no function of the "
        f"recorded channels can avoid, estimated from repeats of the same state"
        if comparison.noise_floor is not None
        else f"no noise floor: {comparison.noise_floor_why}"
    )
    return _joined(
        f"{len(models)} model{'s' if len(models) > 1 else ''} on {file_name(r)}",
        paragraph(scored_sentence(r)),
        overview,
        paragraph(f"Held-out: {_compared(comparison)}. {floor[0].upper()}{floor[1:]}.", 2),
        _regimes_text(comparison),
        notes_text(r.notes, *(a.fit.notes for a in models)),
    )


def _compared(comparison: Comparison) -> str:
    """What "held out" means: specs are fitted here, model files are not."""
    stored = [a.fit.starts == 0 for a in comparison.models]
    file = "a model file is not fitted again, its error on data it was not fitted to counts"
    if all(stored):
        return file
    fitted = held_out_meaning(comparison.recording)
    return f"{fitted}; {file}" if any(stored) else fitted


def _regimes_text(comparison: Comparison) -> str:
    """RMSE by regime: one column a model, the worst places marked."""
    models, unit = comparison.models, comparison.recording.torque_unit
    if not models or not models[0].regimes:
        return ""
    blocks = []
    for first in range(0, len(models), 3):
        part = models[first : first + 3]
        tags = [a.model if len(a.model) <= 16 else f"[{first + k}]" for k, a in enumerate(part, 1)]
        heading = [f"RMSE (mean error) [{unit}]", "rows", *tags]
        rows = [heading]
        for index, regime in enumerate(part[0].regimes):
            cells = []
            for a in part:
                g = a.regimes[index]
                mark = "▲" if g.regime != "standstill" and g.rmse > 1.2 * a.rmse else " "
                cells.append(f"{plain(g.rmse)} ({_signed(g.bias, g.rmse)}) {mark}")
            rows.append([REGIMES[regime.regime], percent(regime.share), *cells])
        text = table(rows, right=range(1, len(heading)))
        long = [f"  {tag} {a.model}" for tag, a in zip(tags, part, strict=True) if tag[0] == "["]
        blocks.append("\n".join([text, *long]))
    legend = (
        "Where each model fails: ▲ marks an error at least 1.2 times the model's average; the "
        "mean error is measured minus model."
    )
    return paragraph(legend) + "\n\n" + "\n\n".join(blocks)


def _signed(value: float, beside: float) -> str:
    """`value` with its sign and as many decimals as `beside` shows."""
    decimals = len(plain(beside).partition(".")[2]) if "e" not in plain(beside) else 9
    shown = f"{abs(value):.{decimals}f}"
    return ("+" if value > 0 else MINUS) + shown if shown.strip("0.") else shown


def finding_text(finding: Finding, number: int | None = None) -> str:
    """One finding: what, how sure, what it is, where it shows, what it brings."""
    unit = finding.fit.model.torque_unit
    fall = ""
    if finding.share_of_unexplained is not None:
        fall = (
            f", {percent(finding.share_of_unexplained)} of the squared error above the noise floor"
        )
    lead = "" if number is None else f"{number}. "
    parts = [
        f"  {lead}{finding.effect}: {confidence_words(finding.confidence)}",
        paragraph(physically(finding.effect, finding.fit.model), 5),
        paragraph(f"Here: {finding.where}.", 5),
        paragraph(
            f"Held-out error {plain(finding.rmse_held_out_before)} → "
            f"{plain(finding.rmse_held_out_after)} {unit}{fall}.", 5,
        ),
    ]  # fmt: skip
    if finding.indistinguishable_from:
        parts.append(paragraph(indistinguishable_sentence(finding), 5))
    return "\n".join(parts)


def indistinguishable_sentence(finding: Finding) -> str:
    """Which other effects predict as well."""
    return (
        f"Cannot be told apart from {listed(finding.indistinguishable_from, 'or')} on this data: "
        f"the difference in held-out error is within chance; the simplest comes first."
    )


def untestable_rows(rows: Iterable[Untestable]) -> list[tuple[str, str, str]]:
    """Effects with the same reason together: (effects, why, do)."""
    grouped: dict[tuple[str, str], list[str]] = {}
    for row in rows:
        grouped.setdefault((row.why, row.do), []).append(row.effect)
    return [(listed(names), why, do) for (why, do), names in grouped.items()]


def untestable_text(rows: Iterable[Untestable]) -> str:
    """Effects that the data cannot show, why, and what would show them."""
    grouped = untestable_rows(rows)
    if not grouped:
        return ""
    lines = ["This data cannot show, one way or the other:"]
    for names, why, do in grouped:
        lines.append(paragraph(f"• {names}: {why}. To see it: {do}.", 2, 2))
    return "\n".join(lines)


#: What stands above the two lists of a diagnosis.
VISIBLE = "Not found, and would have been seen (19 times in 20) from a torque, RMS, of"
ALIKE = "This data cannot tell apart"


def visible_rows(rows: Sequence[SmallestVisible]) -> list[str]:
    """From which size on each effect that was not found would have been, like sizes together."""
    bands: list[list[SmallestVisible]] = []
    for row in sorted(rows, key=lambda row: row.rms):
        if not bands or row.rms > 1.5 * bands[-1][0].rms:
            bands.append([])
        bands[-1].append(row)
    return [f"{plain(b[-1].rms, 2)} {b[-1].unit}: {listed([r.effect for r in b])}." for b in bands]


def group_rows(groups: Sequence[Group]) -> list[str]:
    """Which effects look alike on this data, and from which size on they do not."""
    return [
        listed(group.effects)
        + (f", below {plain(group.rms, 2)} {group.unit} RMS" if math.isfinite(group.rms) else "")
        + "."
        for group in groups
    ]


def _list_text(heading: str, rows: Iterable[str]) -> str:
    lines = [paragraph(f"• {row}", 2, 2) for row in rows]
    return "\n".join([f"{heading}:", *lines]) if lines else ""


def left_text(left: Unexplained) -> str:
    """How much of the error is more than noise."""
    if left.share is None:
        return "How much of what is left is noise cannot be said on this data."
    if not left.is_structure:
        return (
            f"Of the squared held-out error that is left, {percent(left.share)} follows something: "
            f"too little to call structure."
        )
    where = f", and {left.where}" if left.where and left.where != "everywhere" else ""
    return (
        f"Of the squared held-out error that is left, {percent(left.share)} is more than noise"
        f"{where}."
    )


def above_noise_text(fitted: Fit, floor: NoiseFloor) -> str:
    """Why an error without structure that could be shown exceeds the noise floor."""
    if floor.value is None or fitted.rmse_held_out is None:
        return ""
    if not floor.is_reached_by(fitted.rmse):
        return (
            f"Repeats of the same state differ by {plain(floor.value)} {fitted.model.torque_unit} "
            f"only: what {fitted.model.spec} leaves repeats, but is no function of what was "
            "recorded (vibration of the structure, say)."
        )
    if fitted.rmse > AT_THE_NOISE * floor.value or fitted.rmse_held_out < FORETOLD * fitted.rmse:
        return ""
    return (
        f"Fitted to all rows {fitted.model.spec} leaves {plain(fitted.rmse)} "
        f"{fitted.model.torque_unit}, the noise: the held-out error is larger because a part of "
        "the recording shows what no other part foretells. A longer recording would settle it."
    )


def explainable_text(explainable: Explainable | None, spec: str, unit: str) -> str:
    """How much of what the channels could show a model explains."""
    if explainable is None:
        return ""
    share = f"{100.0 * explainable.share:.1f} %" if explainable.share < 0.9995 else "> 99.9 %"
    return (
        f"{spec} explains {share} of the variation of the torque that these channels could show: a "
        f"flexible regressor on top, which knows no physics, leaves {plain(explainable.rmse)} "
        f"{unit} on data that neither has seen."
    )


def _floor_sentence(value: float | None, why: str | None, unit: str) -> str:
    if value is None:
        return f"The noise floor cannot be estimated: {why}."
    return (
        f"Noise floor {plain(value)} {unit}: the error that no function of the recorded channels "
        f"can avoid, estimated from repeats of the same state."
    )


def errors_sentence(diagnosis: Diagnosis) -> str:
    """How large the error is, and the noise."""
    f, floor = diagnosis.fit, diagnosis.noise_floor
    unit = f.model.torque_unit
    noise = _floor_sentence(floor.value, floor.why, unit)
    if f.rmse_held_out is None:
        return noise
    meaning = held_out_meaning(f.recording)
    return f"Held-out error {plain(f.rmse_held_out)} {unit} ({meaning}). {noise}"


def left_after(diagnosis: Diagnosis) -> str:
    """How much of the error is more than noise once the first finding is added."""
    left = left_text(diagnosis.unexplained)
    if not diagnosis.findings:
        return left
    return f"With {diagnosis.findings[0].effect} added: {left[0].lower()}{left[1:]}"


def diagnosis_summary(diagnosis: Diagnosis) -> str:
    """What a diagnosis found, in one sentence."""
    spec, unit = diagnosis.fit.model.spec, diagnosis.fit.model.torque_unit
    if diagnosis.verdict == "none":
        return f"Nothing that this recording can show is missing from the model {spec}."
    if not diagnosis.findings:
        return (
            f"The model {spec} misses something on this recording, but no known effect explains "
            f"it on data that it has not seen."
        )
    best = diagnosis.findings[0]
    return (
        f"What the model {spec} lacks most is {best.effect}: with it the error on data the fit has "
        f"not seen falls from {plain(best.rmse_held_out_before)} to "
        f"{plain(best.rmse_held_out_after)} {unit}."
    )


def diagnosis_text(diagnosis: Diagnosis) -> str:
    """What is missing from a model."""
    f = diagnosis.fit
    r, unit = f.recording, f.model.torque_unit
    verdict = {
        "missing": "Missing, best first:",
        "none": "Nothing is missing: what the model leaves is noise.",
        "unexplained": "Something is missing, but none of the known effects explains it.",
    }[diagnosis.verdict]
    findings = "\n\n".join(
        finding_text(finding, k) for k, finding in enumerate(diagnosis.findings, 1)
    )
    following = ""
    if diagnosis.findings:
        following = (
            "Each effect was tried alone. Add the first and diagnose again (stribeck improve does "
            "that): others may then vanish or appear."
        )
    return _joined(
        f"What is missing from {f.model.spec} on {file_name(r)}?",
        paragraph(errors_sentence(diagnosis)),
        verdict + ("\n\n" + findings if findings else ""),
        paragraph(left_after(diagnosis), 0),
        paragraph(explainable_text(diagnosis.explainable, f.model.spec, unit), 0),
        paragraph(following, 0) if following else "",
        _list_text(VISIBLE, visible_rows(diagnosis.smallest_visible)),
        _list_text(ALIKE, group_rows(diagnosis.groups)),
        untestable_text(diagnosis.untestable),
        notes_text(r.notes, f.notes),
    )


def addition_text(addition: Addition) -> str:
    """An effect added: error before and after, and the new parameters."""
    before, after, effect = addition.before, addition.after, addition.effect
    unit = after.model.torque_unit
    have = before.rmse_held_out is not None and after.rmse_held_out is not None
    first = before.rmse_held_out if have else before.rmse
    second = after.rmse_held_out if have else after.rmse
    assert first is not None and second is not None
    kind = f"held-out error ({held_out_meaning(after.recording)})" if have else "error"
    fell = second < first
    verdict = (
        f"The {kind} {'falls' if fell else 'does not fall: it rises'} by "
        f"{percent(abs(1 - second / first))}, from {plain(first)} to {plain(second)} {unit}"
    )
    advice = "" if fell else ": the effect does not help on data it has not seen"
    return _joined(
        f"{effect} added to {before.model.spec} on {file_name(after.recording)}",
        paragraph(physically(effect, after.model)),
        bars([before.model.spec, f"+ {effect}"], [first, second], None, unit),
        paragraph(f"{verdict}{advice}."),
        parameters_text(after.estimates),
        _errors_text(after),
        notes_text(after.recording.notes, after.notes),
    )


def step_labels(improvement: Improvement) -> list[str]:
    """The base and each added effect."""
    return [improvement.base.model.spec, *(f"+ {s.finding.effect}" for s in improvement.steps)]


def step_errors(improvement: Improvement) -> list[float | None]:
    """Held-out error of the base and after each step."""
    return [improvement.base.rmse_held_out, *(s.after.rmse_held_out for s in improvement.steps)]


def improvement_bars(improvement: Improvement) -> str:
    """A bar a step for the held-out error, with the noise floor shaded."""
    return bars(
        step_labels(improvement), step_errors(improvement), improvement.noise_floor.value,
        improvement.final.model.torque_unit,
    )  # fmt: skip


def summary_sentence(improvement: Improvement) -> str:
    """What was found, in one sentence."""
    base, final = improvement.base, improvement.final
    unit, spec = final.model.torque_unit, base.model.spec
    if not improvement.steps:
        left = improvement.unexplained
        if left.is_structure:
            return (
                f"The model {spec} misses something on this recording, but no known effect "
                f"explains it on data that it has not seen."
            )
        return f"Nothing that this recording can show is missing from the model {spec}."
    found = listed([step.finding.effect for step in improvement.steps])
    text = f"The model {spec} lacks {found}"
    if base.rmse_held_out is not None and final.rmse_held_out is not None:
        text += (
            f": with {'it' if len(improvement.steps) == 1 else 'them'} the error on data the fit "
            f"has not seen falls from {plain(base.rmse_held_out)} to {plain(final.rmse_held_out)} "
            f"{unit}"
        )
        floor = improvement.noise_floor.value
        if floor is not None and final.rmse_held_out < 1.1 * floor:
            text += f", and what is left is noise ({plain(floor)} {unit})"
        elif floor is not None:
            text += f"; the noise is {plain(floor)} {unit}"
    return text + "."


def improvement_text(improvement: Improvement) -> str:
    """The way from the base model to the last one."""
    final = improvement.final
    r, unit = final.recording, final.model.torque_unit
    floor = improvement.noise_floor
    steps = "\n\n".join(
        finding_text(step.finding, k) for k, step in enumerate(improvement.steps, 1)
    )
    is_structure = improvement.unexplained.is_structure
    stopped = STOPPED[improvement.stopped]
    return _joined(
        f"Improving {improvement.base.model.spec} on {file_name(r)}",
        paragraph(summary_sentence(improvement), 0),
        paragraph(f"Held-out error after each step ({held_out_meaning(r)}):", 0)
        + f"\n\n{improvement_bars(improvement)}",
        paragraph(_floor_sentence(None, floor.why, unit), 0) if floor.value is None else "",
        ("Found, in this order:\n\n" + steps) if steps else "",
        paragraph(f"{stopped} {left_text(improvement.unexplained)}", 0),
        paragraph("" if is_structure else above_noise_text(final, floor), 0),
        paragraph(explainable_text(improvement.last.explainable, final.model.spec, unit), 0),
        f"The model now: {final.model.spec}\n\n{parameters_text(final.estimates)}",
        _errors_text(final),
        untestable_text(improvement.untestable),
        notes_text(r.notes, final.notes),
    )


def catalog_text(rows: Iterable[Mapping[str, Any]], last: str) -> str:
    """Laws or effects, one paragraph each; `last` names the key that ends it."""
    lines = []
    for row in rows:
        lines.append(f"{row['id']}: {row['title']}")
        source = f"  [{row['source']}]" if "source" in row else f"  [{row['group']}]"
        lines.append(paragraph(f"{row['formula']}{source}", 4, 2))
        if "what" in row:
            lines.append(paragraph(row["what"], 4))
        names = ", ".join(
            f"{p['name']} ({p['symbol']}, {unit_text(p['unit'])})" for p in row["parameters"]
        )
        lines.append(paragraph(f"parameters: {names}", 4, 2))
        value = row[last]
        said = value if isinstance(value, str) else listed(value)
        lines.append(paragraph(f"{last}: {said}", 4, 2))
    lines.append("In units, T stands for N m or N, X for rad or m.")
    return "\n".join(lines)


def inspection_text(inspection: Inspection) -> str:
    """What a file holds, and what it can show."""
    t = inspection.table
    lines = [f"{Path(t.path).name}: {t.rows} rows, {t.runs} run{'s' * (t.runs != 1)}"]
    if t.rate_hz:
        lines[0] += f", {plain(t.rate_hz)} Hz"
    if t.gaps:
        lines[0] += f", {t.gaps} gap{'s' * (t.gaps != 1)}"
    if t.joints:
        lines.append(f"  joints: {', '.join(t.joints)}")
    shown = dict(t.channels)
    for r in inspection.recordings[:1]:
        shown = {**r.columns, **shown}
    rows = [["channel", "from", "unit", "min", "max"]]
    rows += [
        [name, c.source, c.unit, plain(c.minimum), plain(c.maximum)] for name, c in shown.items()
    ]
    lines += ["", table(rows, {3, 4})]
    if inspection.problem is not None:
        lines += ["", paragraph(f"Not readable as a recording yet: {inspection.problem}", 0)]
        return "\n".join(lines)
    for r in inspection.recordings:
        lines += ["", paragraph(scored_sentence(r), 0)]
    lines += ["", f"It can show: {listed(inspection.testable) or 'no effect'}."]
    lines.append(untestable_text(inspection.untestable.values()))
    return "\n".join(lines).rstrip()
