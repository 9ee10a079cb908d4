"""`stribeck demo`: the whole loop on the shipped recording."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Any

import click

from stribeck.base.errors import StribeckError
from stribeck.base.files import write_whole
from stribeck.cli.common import echo_json, json_option, save_fit, say, seed_option
from stribeck.diagnosis.compare import Comparison, compare
from stribeck.diagnosis.improve import Improvement, improve
from stribeck.diagnosis.result import Diagnosis
from stribeck.effect.describe import physically
from stribeck.fitting.result import Fit
from stribeck.motion.generate.demo import DEMO, demo_path, demo_recording
from stribeck.recording.load import read
from stribeck.recording.recording import Recording
from stribeck.report.comparison import worst_places
from stribeck.report.diagnosis import indistinguishable_sentence, untestable_text
from stribeck.report.improvement import improvement_bars, summary_sentence
from stribeck.report.layout import paragraph, table
from stribeck.report.numbers import confidence_words, listed, plain
from stribeck.report.recording import held_out_meaning

BASE = "coulomb"


@click.command()
@click.option(
    "--output", type=click.Path(file_okay=False), default="stribeck-demo", show_default=True,
    help="Folder for report.html, report.png and model.toml.",
)  # fmt: skip
@seed_option
@json_option
def demo(output: str, seed: int, as_json: bool) -> None:
    """Watch the whole loop on a shipped recording: what is missing, add it, the error falls."""
    began = time.perf_counter()
    folder = Path(output)
    _make_folder(folder)
    recording = read(demo_path())
    improvement = improve(BASE, recording, seed=seed, progress=say)
    comparison = compare([improvement.base], recording)
    files = write_report(improvement, folder)
    seconds = time.perf_counter() - began
    truth = demo_recording()[1]
    if as_json:
        echo_json(
            {
                "data": comparison.to_dict()["data"],
                "compare": comparison.to_dict(),
                "improve": improvement.to_dict(),
                "truth": truth,
                "files": files,
                "seconds": seconds,
            }
        )
        return
    click.echo(tell(improvement, comparison, truth))
    click.echo(
        f"\nWritten in {seconds:.0f} s:\n  {files['page']}   the whole story as a page\n"
        f"  {files['picture']}    its picture\n  {files['model']}    the model, ready for use\n\n"
        f"On your own data: stribeck inspect DATA, then stribeck improve DATA"
    )


def _make_folder(folder: Path) -> None:
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise StribeckError(
            f"cannot make the folder {folder}: {error.strerror or error}; choose another with "
            f"--output"
        ) from None


def write_report(improvement: Improvement, folder: Path) -> dict[str, str]:
    """Write page, picture and model file; return where they are."""
    # Drawing is slow to import, and the commands above it must not wait for it.
    from stribeck.base.files import save_figure
    from stribeck.report.improvement_figure import improvement_figure
    from stribeck.report.page import improvement_page

    page, picture, model = folder / "report.html", folder / "report.png", folder / "model.toml"
    save_figure(improvement_figure(improvement), picture)
    write_whole(page, improvement_page(improvement))
    save_fit(improvement.final, str(model))
    return {"page": str(page), "picture": str(picture), "model": str(model)}


def tell(improvement: Improvement, comparison: Comparison, truth: dict[str, Any]) -> str:
    """The four steps, as a person would tell them."""
    base, final = improvement.base, improvement.final
    r = final.recording
    parts = [
        _opening(r),
        _compared(base, improvement),
        _where(comparison),
        _missing(improvement),
        _added(improvement),
        _left(improvement.last, truth, final),
    ]
    return "\n\n".join(part for part in parts if part)


def _opening(r: Recording) -> str:
    seconds = float(r.dt.sum())
    return paragraph(
        f"A recording of one joint: {plain(seconds, 2)} s at {plain(r.rate_hz)} Hz, moving up to "
        f"{plain(r.scales()['speed'], 2)} {r.position_unit}/s, with its motor torque, load torque "
        f"and temperature. It was made by this package (seed {DEMO['seed']}), and friction in it "
        f"holds something that the base model does not know.", 0,
    )  # fmt: skip


def _compared(base: Fit, improvement: Improvement) -> str:
    unit = base.model.torque_unit
    values = {name: e for name, e in base.estimates.items()}
    coulomb, viscous = values["coulomb_friction"], values["viscous_friction"]
    text = (
        f"Fitted: Coulomb friction {plain(coulomb.value)} {coulomb.unit} and viscous friction "
        f"{plain(viscous.value)} {viscous.unit}. "
    )
    if base.rmse_held_out is not None:
        text += (
            f"On data that the fit has not seen ({held_out_meaning(base.recording)}) its torque is "
            f"wrong by {plain(base.rmse_held_out)} {unit} (RMSE). "
        )
        floor = improvement.noise_floor.value
        if floor is not None:
            text += (
                f"The noise is about {plain(floor)} {unit}, so the model is off "
                f"{base.rmse_held_out / floor:.1f} times more than it has to be."
            )
    return f"1. Compare: the base model, {base.model.spec}, against the measurements\n\n" + (
        paragraph(text, 3)
    )


def _where(comparison: Comparison) -> str:
    places = worst_places(comparison.models[0])
    if not places:
        body = paragraph("The error is about the same everywhere.", 3)
    else:
        body = "\n".join(paragraph(f"• {place}", 3, 2) for place in places)
    return f"2. Where it fails\n\n{body}"


def _missing(improvement: Improvement) -> str:
    lines = ["3. What is missing", ""]
    if not improvement.steps:
        lines.append(paragraph(summary_sentence(improvement), 3))
    for step in improvement.steps:
        finding = step.finding
        before = "" if step is improvement.steps[0] else "Then, with that added, "
        text = f"{before}{finding.effect}: {confidence_words(finding.confidence)}."
        lines.append(paragraph(text, 3))
        lines.append(paragraph(physically(finding.effect, finding.fit.model), 5))
        lines.append(paragraph(f"Here: {finding.where}.", 5))
        if finding.indistinguishable_from:
            lines.append(paragraph(indistinguishable_sentence(finding), 5))
    untestable = untestable_text(improvement.untestable)
    if untestable:
        lines += ["", *(f"   {line}" for line in untestable.splitlines())]
    return "\n".join(lines)


def _added(improvement: Improvement) -> str:
    shown = "\n".join(f" {line}" for line in improvement_bars(improvement).splitlines())
    return (
        f"4. Add {'it' if len(improvement.steps) == 1 else 'them'}: the error on unseen data falls"
        f"\n\n{shown}\n\n{paragraph(summary_sentence(improvement), 3)}"
    )


def _left(last: Diagnosis, truth: dict[str, Any], final: Fit) -> str:
    """The truth, which only a made recording can tell."""
    hidden = truth["hidden"]
    found = set(final.model.effects) == set(hidden)
    rows = [["parameter", "in the recording", "found", "unit"]]
    for name, p in truth["parameters"].items():
        e = final.estimates.get(name)
        if e is None or p["value"] == 0.0 or not e.identifiable or e.at_bound:
            continue
        error = f" ± {plain(e.stderr, 2)}" if e.stderr is not None else ""
        rows.append([name, plain(p["value"]), f"{plain(e.value)}{error}", p["unit"]])
    noise = f"{plain(truth['noise_rms'])} {truth['torque_unit']}"
    verdict = (
        f"What was hidden, now that it may be told: {listed(hidden)}; torque noise {noise}. "
        f"{'That is what was found.' if found else 'That is not what was found.'}"
    )
    return paragraph(verdict, 0) + "\n\n" + table(rows)


__all__ = ["demo", "tell", "write_report"]
