"""Options of fitting commands that one of them cannot take: refused with the reason.

Without this, click would say that there is no such option, and not why or what to do.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping

import click

from stribeck.base.errors import SpecError
from stribeck.cli.options import Command, added

#: Why effects are sought with one value of each parameter.
SHARED_VALUES = (
    "effects are sought with one value of each parameter in all runs; `stribeck fit` and "
    "`stribeck compare` take it"
)
#: How the parameters of one model are found.
_CHOICES = (
    "--start",
    "--bound",
    "--fix",
    "--prior",
    "--constraint",
    "--tie",
    "--loss",
    "--algorithm",
    "--per-run",
)
#: What commands that fit a spec on the way do not take.
OF_A_SPEC = dict.fromkeys(
    (*_CHOICES, "--evaluate"),
    "a spec is fitted with the defaults; give it to `stribeck fit -o M.toml`, and name M.toml here",
)
#: What a project does not take.
OF_A_PROJECT = {
    **dict.fromkeys(
        ("--bound", "--prior", "--constraint", "--tie", "--loss", "--algorithm"),
        "a project's file keeps the values that --fix holds, and no other statement, for the steps "
        "that follow; `stribeck improve` takes it for all steps",
    ),
    "--per-run": SHARED_VALUES,
    "--evaluate": "a project has one recording; to judge a model of it on another, write it by "
    "`stribeck project save`, and use `stribeck compare --evaluate`",
}
#: What the plan of a motion does not take.
OF_A_PLAN = {
    "--per-run": "a motion is planned for one value of each parameter; `stribeck fit` and "
    "`stribeck compare` take it",
    "--evaluate": "it gives a motion and no model to judge; use `stribeck fit --evaluate`",
}
#: What the reduction to points does not take.
OF_POINTS = dict.fromkeys(
    (*_CHOICES, "--evaluate"),
    "it reduces measurements and fits no model; give it to `stribeck fit` with the points",
)
#: What the identification of a planar arm does not take.
OF_AN_ARM = dict.fromkeys(
    _CHOICES,
    "inertia and friction of both joints follow together from one linear least squares, as in the "
    "paper; `stribeck fit --joint NAME` takes it for one joint",
)
#: What a study does not take.
OF_A_STUDY = {
    "--per-run": "a study fits each law with one value of each parameter; `stribeck fit` and "
    "`stribeck compare` take it",
}
#: What a fleet does not take.
OF_A_FLEET = {
    "--per-run": "each file of a fleet has a fit and values of its own already",
    "--evaluate": "a fleet compares the days of each joint; to judge one model on another "
    "recording, use `stribeck fit --evaluate`",
}
#: What whole robots do not take, each for the same reason.
OF_A_ROBOT = dict.fromkeys(
    _CHOICES,
    "the joints of a robot have parameters of the same names, and are identified together by "
    "weighted least squares; `stribeck fit --joint NAME` takes it for one joint",
)
#: What the diagnosis of a robot does not take besides.
OF_A_DIAGNOSIS = {
    "--evaluate": "it gives no model to judge; `stribeck robot improve --evaluate` does",
}


def refusing(reasons: Mapping[str, str]) -> Callable[[Command], Command]:
    """Add hidden options that raise the reason why the command cannot take them.

    Parameters
    ----------
    reasons
        By flag: a clause that says why, and what to do.
    """

    def refuse(ctx: click.Context, param: click.Parameter, value: Iterable[str]) -> None:
        for _ in value:
            flag = param.opts[0]
            raise SpecError(f"`{ctx.command_path}` does not take {flag}: {reasons[flag]}")

    hidden = [
        click.option(flag, multiple=True, hidden=True, expose_value=False, callback=refuse)
        for flag in reasons
    ]
    return lambda command: added(hidden, command)
