"""The pages that commands write with `--report`: one kind for all of them."""

from __future__ import annotations

import click

from stribeck.base.errors import StribeckError
from stribeck.base.files import write_whole
from stribeck.cli.common import say
from stribeck.cli.flags import with_flags
from stribeck.cli.outputs import COMMAND
from stribeck.diagnosis.compare import Comparison, compare
from stribeck.diagnosis.loop.improve import Improvement
from stribeck.diagnosis.result import Diagnosis
from stribeck.diagnosis.testable import untestable
from stribeck.fitting.result import Fit
from stribeck.models.rigid_body import own_load
from stribeck.passivity.certificate import Certificate
from stribeck.passivity.check import check
from stribeck.report.pages.account import (
    Account,
    of_comparison,
    of_diagnosis,
    of_improvement,
)


def comparison_report(comparison: Comparison, path: str | None) -> None:
    """Write the page of models side by side; nothing if `path` is None."""
    if path is None:
        return
    first = comparison.models[0].fit
    cannot = untestable(comparison.recording, own_load(first.model, comparison.recording))
    write_account(of_comparison(comparison, cannot.values()), path)


def fit_report(fitted: Fit, path: str | None) -> None:
    """Write the page of one fit; nothing if `path` is None."""
    if path is not None:
        comparison_report(compare([fitted], fitted.recording), path)


def diagnosis_report(diagnosis: Diagnosis, path: str | None) -> None:
    """Write the page of a diagnosis; nothing if `path` is None."""
    if path is not None:
        write_account(of_diagnosis(diagnosis, _one(diagnosis.fit)), path)


def improvement_report(improvement: Improvement, path: str | None) -> None:
    """Write the page of an improvement; nothing if `path` is None."""
    if path is not None:
        fits = [improvement.base, *(step.after for step in improvement.steps)]
        fits = [*fits[:-1], improvement.final] if improvement.steps else fits
        comparison = compare(fits, improvement.final.recording)
        write_account(of_improvement(improvement, comparison), path)


def write_account(account: Account, path: str) -> None:
    """Write the page of an account, with the command that is running and the proof of passivity."""
    # Bokeh is slow to import.
    from stribeck.report.pages.recording import account_page

    made = account.made_by(command_line(), proof(account.final))
    save_page(account_page(made, with_flags), path)


def save_page(page: str, path: str) -> None:
    """Write a page, all of it or nothing."""
    write_whole(path, page)
    say(f"wrote {path}")


def command_line() -> str:
    """The command that is running, as a shell takes it; empty where there is none."""
    context = click.get_current_context(silent=True)
    return "" if context is None else str(context.meta.get(COMMAND, ""))


def proof(fitted: Fit) -> Certificate | None:
    """The check of passivity of a fit; None where there can be none."""
    try:
        return check(fitted.model)
    except StribeckError:
        return None


def _one(fitted: Fit) -> Comparison:
    return compare([fitted], fitted.recording)
