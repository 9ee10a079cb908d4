"""`stribeck fit`."""

from __future__ import annotations

import click

from stribeck.cli.choices import per_run_option
from stribeck.cli.common import (
    echo_result,
    json_option,
    output_option,
    read_recording,
    recording_options,
    report_option,
    save_fit,
    seed_option,
    starts_option,
)
from stribeck.cli.data import arguments_of, split_one
from stribeck.cli.errors import ErrorChoice, error_options
from stribeck.cli.evaluation import evaluate_option, judged
from stribeck.cli.formulas import (
    Written,
    model_options,
    written_fit,
)
from stribeck.cli.methods import Method, method_options
from stribeck.cli.outputs import CheckedCommand
from stribeck.cli.pages import fit_report
from stribeck.cli.progress import RowProgress
from stribeck.cli.streaming import Streaming, save_streamed, show, stream_options
from stribeck.cli.unread import refuse_unread
from stribeck.cli.words import complete_model
from stribeck.fitting.evaluate import evaluated_on
from stribeck.identify.scaling import model_for
from stribeck.recording.stated.options import ReadOptions
from stribeck.scale.streaming.result import StreamedFit
from stribeck.scale.streaming.stream import Stream


@click.command(cls=CheckedCommand)
@arguments_of("DATA... [MODEL]")
@click.option(
    "--model",
    "spec",
    default=None,
    shell_complete=complete_model,
    help="LAW[+effect...], or a model file to start from; the same as MODEL.",
)
@model_options
@error_options
@click.option(
    "--passive",
    is_flag=True,
    help="Identify under passivity conditions; `stribeck check` proves the result.",
)
@per_run_option
@output_option
@report_option
@method_options
@evaluate_option
@starts_option
@stream_options
@recording_options
@seed_option
@json_option
def fit(
    arguments: tuple[str, ...],
    spec: str | None,
    written: Written,
    errors: ErrorChoice,
    passive: bool,
    per_run: tuple[str, ...],
    output: str | None,
    report: str | None,
    method: Method,
    evaluate: tuple[str, ...],
    starts: int,
    streaming: Streaming,
    reading: ReadOptions,
    seed: int,
    as_json: bool,
) -> None:
    """Identify a model's parameters on DATA; several files are runs of one joint.

    With --stream, Parquet files are read in passes: all samples are fitted, few are in memory.
    """
    data, spec = split_one(arguments, "--model", spec)
    if streaming.asked:
        streaming.refuse(
            method=method.name != "rms",
            estimator=method.estimator != "ls",
            passive=passive,
            errors=errors.errors != "robust",
            evaluate=bool(evaluate),
            per_run=bool(per_run),
            report=report is not None,
        )
        streamed = _in_passes(streaming.open(data, reading, seed), written, spec, starts, seed)
        if output is not None:
            save_streamed(streamed, output)
        show(streamed, as_json)
        return
    refuse_unread("without --stream", {"sample_rows": "with it"})
    recording, others = read_recording(data, reading), judged(evaluate, reading)
    if method.name == "rms":
        fitted = written_fit(
            spec,
            written,
            recording,
            starts=starts,
            seed=seed,
            passive=passive,
            estimator=method.estimator,
            per_run=per_run,
            **errors.options,
        )
    else:
        model = written.choices.applied(model_for(written.model(spec), recording))
        fitted = method.fit(model, recording, reading, starts=starts, seed=seed)
    fitted = evaluated_on(fitted, others)
    if output is not None:
        save_fit(fitted, output)
    fit_report(fitted, report)
    echo_result(fitted, as_json)


def _in_passes(
    opened: Stream, written: Written, spec: str | None, starts: int, seed: int
) -> StreamedFit:
    """The fit of data that is read in passes, with its progress on stderr."""
    with RowProgress() as bar:
        return opened.fit(
            written.model(spec),
            told=bar.show_pass,
            starts=starts,
            seed=seed,
            **written.choices.arguments(),
        )
