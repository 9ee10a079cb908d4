"""The loop's commands after `fit`: compare, diagnose, add, improve."""

from __future__ import annotations

import sys
from dataclasses import replace

import click

from stribeck.base.errors import SpecError
from stribeck.cli import interrupts
from stribeck.cli.choices import per_run_option
from stribeck.cli.common import (
    echo_result,
    figures_option,
    json_option,
    least_fall_option,
    output_option,
    read_recording,
    recording_options,
    report_option,
    save_findings,
    save_fit,
    say,
    seed_option,
    starts_option,
)
from stribeck.cli.data import arguments_of, arguments_of_both, split, split_one
from stribeck.cli.evaluation import evaluate_option, judged, refuse_fitted, with_judgements
from stribeck.cli.fitted import fits_of
from stribeck.cli.formulas import (
    Written,
    candidate_option,
    check_candidates,
    formula_options,
    model_options,
    written_fit,
)
from stribeck.cli.options import Values
from stribeck.cli.outputs import FIGURE, CheckedCommand
from stribeck.cli.pages import comparison_report, diagnosis_report, improvement_report
from stribeck.cli.progress import RowProgress
from stribeck.cli.refused import SHARED_VALUES, refusing
from stribeck.cli.streaming import Streaming, save_streamed, show, stream_options
from stribeck.cli.words import complete_model
from stribeck.diagnosis.compare import compare as compare_fits
from stribeck.diagnosis.diagnose import diagnose as diagnose_fit
from stribeck.diagnosis.loop.add import Addition, parameters_brought_by
from stribeck.diagnosis.loop.add import add as add_to
from stribeck.diagnosis.loop.improve import Improvement
from stribeck.diagnosis.loop.improve import improve as improve_from
from stribeck.diagnosis.trials.dry_friction import check_rejected
from stribeck.fitting.evaluate import evaluated_on
from stribeck.identify.stated.choices import parameters_of_effects
from stribeck.models.formula_law import effect_name
from stribeck.recording.recording import Recording
from stribeck.recording.stated.options import ReadOptions
from stribeck.scale.streaming.diagnosis import StreamedDiagnosis
from stribeck.scale.streaming.improvement import StreamedImprovement


@click.command(cls=CheckedCommand)
@arguments_of_both
@formula_options
@per_run_option
@evaluate_option
@click.option(
    "--plot", "picture", type=FIGURE, metavar="FILE", help="Write a figure of the residuals (PNG)."
)
@report_option
@starts_option
@recording_options
@seed_option
@json_option
def compare(
    arguments: tuple[str, ...],
    written: Written,
    per_run: tuple[str, ...],
    evaluate: tuple[str, ...],
    picture: str | None,
    report: str | None,
    starts: int,
    reading: ReadOptions,
    seed: int,
    as_json: bool,
) -> None:
    """Compare MODELS (specs, model files or formulas) with DATA, and show where each fails."""
    data, models = split(arguments)
    if not (models or written.laws):
        raise SpecError("no model is given: name laws or model files, or write laws by --law")
    recording, others = read_recording(data, reading), judged(evaluate, reading)
    refuse_fitted(models, others)
    fits = fits_of(models, written, recording, starts=starts, seed=seed, per_run=per_run)
    comparison = compare_fits(fits, recording)
    if picture is not None:
        from stribeck.base.files import save_figure

        save_figure(comparison.plot(), picture)
        say(f"wrote {picture}")
    comparison_report(comparison, report)
    echo_result(with_judgements(comparison, fits, others), as_json)


@click.command(cls=CheckedCommand)
@arguments_of_both
@model_options
@refusing({"--per-run": SHARED_VALUES})
@evaluate_option
@report_option
@figures_option
@candidate_option
@least_fall_option
@starts_option
@stream_options
@recording_options
@seed_option
@json_option
def diagnose(
    arguments: tuple[str, ...],
    written: Written,
    evaluate: tuple[str, ...],
    report: str | None,
    figures: str | None,
    candidates: tuple[str, ...],
    least_fall: float,
    starts: int,
    streaming: Streaming,
    reading: ReadOptions,
    seed: int,
    as_json: bool,
) -> None:
    """Find which physical effect MODEL (or the law of --law) lacks on DATA.

    With --stream, effects are searched on stretches of the data.
    """
    data, models = split(arguments)
    if len(models) > 1:
        raise SpecError(f"one model is needed, {len(models)} are given: {', '.join(models)}")
    model = models[0] if models else None
    check_candidates(candidates)
    streamed: StreamedDiagnosis | None = None
    others: list[Recording] = []
    if streaming.asked:
        streaming.refuse(evaluate=bool(evaluate))
        opened = streaming.open(data, reading, seed)
        with RowProgress() as bar:
            streamed = opened.diagnose(
                written.model(model),
                starts=starts,
                seed=seed,
                least_fall=least_fall,
                candidates=candidates,
                told=bar.show_pass,
                **written.choices.arguments(),
            )
        diagnosis = streamed.found
    else:
        recording, others = read_recording(data, reading), judged(evaluate, reading)
        later = parameters_of_effects(candidates=candidates)
        fitted = written_fit(model, written, recording, later, starts=starts, seed=seed)
        diagnosis = diagnose_fit(
            fitted,
            recording,
            least_fall=least_fall,
            candidates=candidates,
            seed=seed,
            sample_rows=streaming.sample_rows,
        )
    save_findings((*diagnosis.findings, *diagnosis.demoted), figures)
    diagnosis_report(diagnosis, report)
    if streamed is not None:
        show(streamed, as_json)
    else:
        echo_result(with_judgements(diagnosis, [diagnosis.fit], others), as_json)


@click.command(cls=CheckedCommand)
@arguments_of("DATA... MODEL EFFECT")
@model_options
@refusing({"--per-run": SHARED_VALUES})
@evaluate_option
@output_option
@starts_option
@recording_options
@seed_option
@json_option
def add(
    arguments: tuple[str, ...],
    written: Written,
    evaluate: tuple[str, ...],
    output: str | None,
    starts: int,
    reading: ReadOptions,
    seed: int,
    as_json: bool,
) -> None:
    """Add EFFECT to MODEL, refit on DATA, and show the error before and after.

    MODEL may be a law by formula, EFFECT an effect by formula, 'NAME = FORMULA'.
    """
    data, named = split(arguments)
    if len(named) != 2:
        raise SpecError(
            f"one model and one effect are needed beside the data, not {len(named)} "
            f"({', '.join(named) or 'none'}): write `stribeck add DATA MODEL EFFECT`"
        )
    model, effect = named
    recording = read_recording(data, reading)
    others = judged(evaluate, reading, recording)
    before = written_fit(
        model, written, recording, parameters_brought_by(effect), starts=starts, seed=seed
    )
    after = add_to(before, effect, recording, starts=starts, seed=seed)
    addition = Addition(effect_name(effect), before, after)
    if output is not None:
        save_fit(after, output)
    echo_result(with_judgements(addition, [before, after], others), as_json)


@click.command(cls=CheckedCommand)
@arguments_of("DATA... [MODEL]")
@click.option(
    "--base",
    default=None,
    shell_complete=complete_model,
    help="Spec, model file or formula; the same as MODEL. [default: coulomb]",
)
@model_options
@refusing({"--per-run": SHARED_VALUES})
@output_option
@report_option
@click.option("--plot", "picture", type=FIGURE, metavar="FILE", help="Write the figure (PNG).")
@figures_option
@evaluate_option
@least_fall_option
@click.option(
    "--max-steps",
    type=click.IntRange(min=0),
    default=8,
    show_default=True,
    help="Largest number of effects to add.",
)
@candidate_option
@click.option("--reject", multiple=True, metavar="EFFECT", help="Never add this effect.")
@starts_option
@stream_options
@recording_options
@seed_option
@json_option
def improve(
    arguments: tuple[str, ...],
    base: str | None,
    written: Written,
    output: str | None,
    report: str | None,
    picture: str | None,
    figures: str | None,
    evaluate: tuple[str, ...],
    least_fall: float,
    max_steps: int,
    candidates: tuple[str, ...],
    reject: tuple[str, ...],
    starts: int,
    streaming: Streaming,
    reading: ReadOptions,
    seed: int,
    as_json: bool,
) -> None:
    """Diagnose and add effects to a base model until the residual is noise.

    With --stream, effects are searched on stretches of the data.
    """
    data, base = split_one(arguments, "--base", base)
    check_candidates(candidates)
    check_rejected(reject)
    if base is None and not written.laws:
        base = "coulomb"
    start = written.model(base)
    options: Values = dict(
        starts=starts, seed=seed, least_fall=least_fall, most_steps=max_steps, rejected=reject
    )
    options |= {**written.choices.arguments(), "candidates": candidates, "progress": say}
    options["keep_when_stopped"] = True
    streamed: StreamedImprovement | None = None
    if streaming.asked:
        streaming.refuse(evaluate=bool(evaluate))
        opened = streaming.open(data, reading, seed)
        with RowProgress() as bar:
            streamed = opened.improve(start, told=bar.show_pass, **options)
        improvement = streamed.found
    else:
        recording = read_recording(data, reading)
        others = judged(evaluate, reading, recording)
        improvement = improve_from(start, recording, sample_rows=streaming.sample_rows, **options)
        improvement = replace(improvement, final=evaluated_on(improvement.final, others))
    if output is not None:
        if streamed is not None:
            save_streamed(streamed.final, output)
        else:
            save_fit(improvement.final, output)
    _write_pictures(improvement, picture, figures, report)
    if streamed is not None:
        show(streamed, as_json)
    else:
        echo_result(improvement, as_json)
    if improvement.stopped == "interrupted":
        sys.exit(interrupts.STOPPED)


def _write_pictures(
    improvement: Improvement, picture: str | None, figures: str | None, report: str | None
) -> None:
    if picture is not None:
        from stribeck.base.files import save_figure

        save_figure(improvement.plot(), picture)
        say(f"wrote {picture}")
    save_findings([step.finding for step in improvement.steps], figures)
    improvement_report(improvement, report)
