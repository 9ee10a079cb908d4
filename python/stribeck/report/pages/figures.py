"""The interactive figures of a page, as text that the page holds."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from markupsafe import Markup

from stribeck.report.finding_view import finding_view
from stribeck.report.interactive.correlation import correlation
from stribeck.report.interactive.falling_error import falling_error
from stribeck.report.interactive.finding_residual import evidence, evidence_columns
from stribeck.report.interactive.findings import findings
from stribeck.report.interactive.friction_velocity import friction_velocity
from stribeck.report.interactive.hysteresis import hysteresis
from stribeck.report.interactive.intervals import intervals
from stribeck.report.interactive.residual_channel import residual_channel
from stribeck.report.interactive.robot_joint import joint_friction, joint_residual
from stribeck.report.interactive.robot_samples import robot_samples
from stribeck.report.interactive.samples import CHANNELS, Samples, samples_of
from stribeck.report.interactive.time import residual_time, time

if TYPE_CHECKING:
    from bokeh.plotting import figure

    from stribeck.fitting.result import Fit
    from stribeck.report.pages.account import Account
    from stribeck.robot.result import RobotFit

#: Correlations of fewer parameters than this are no figure.
FEWEST_CORRELATED = 2


@dataclass(frozen=True)
class Figures:
    """Figures as HTML: the library, a place for each, and the script that fills the places."""

    library: Markup
    places: Mapping[str, Markup]
    script: Markup


#: Of a page whose pictures are none of these.
NO_FIGURES = Figures(Markup(), {}, Markup())


def figures_of(plots: Mapping[str, figure]) -> Figures:
    """Figures that need neither the network nor a server.

    Parameters
    ----------
    plots : mapping of figures
        By the names under which `places` has them.
    """
    if not plots:
        return NO_FIGURES
    from bokeh.embed import components
    from bokeh.resources import Resources

    resources = Resources(mode="inline", components=["bokeh"])
    script, places = components(dict(plots))
    return Figures(
        Markup(resources.render()),
        {name: Markup(place) for name, place in places.items()},
        Markup(script),
    )


def account_plots(account: Account) -> dict[str, figure]:
    """Every figure of a page, by name."""
    views = {
        f"step {k}": finding_view(step.effect, step.before, step.after)
        for k, step in enumerate(account.steps, 1)
    }
    samples = samples_of(account.models)
    samples = samples.with_columns(evidence_columns(views, samples.rows))
    plots = sample_plots(samples)
    for (name, view), step in zip(views.items(), account.steps, strict=True):
        plots[name] = evidence(step.effect, view, samples.unit, samples, name)
    plots |= _errors(account)
    return plots | parameter_plots(account.final)


def parameter_plots(fit: Fit) -> dict[str, figure]:
    """Intervals and correlations of the parameters, where they are known."""
    plots: dict[str, figure] = {}
    estimates = fit.estimates.values()
    if any(e.ci95 is not None and e.value != 0.0 for e in estimates):
        plots["intervals"] = intervals(estimates)
    matrix = fit.correlation
    if matrix is not None and len(matrix.names) >= FEWEST_CORRELATED:
        plots["correlation"] = correlation(matrix)
    return plots


def sample_plots(samples: Samples) -> dict[str, figure]:
    """The figures that share samples; time and its residual share their range too."""
    over_time = time(samples)
    plots = {"friction": friction_velocity(samples), "time": over_time}
    if not samples.fits[0].recording.averaged:
        plots["residual"] = residual_time(samples, x_range=over_time.x_range)
    for name in ("position", "reversal"):
        if name in samples.labels:
            plots[f"loop {name}"] = hysteresis(samples, name)
    for name in CHANNELS:
        if name in samples.labels and name != "time":
            plots[f"against {name}"] = residual_channel(samples, name)
    return plots


def _errors(account: Account) -> dict[str, figure]:
    """The error after each step, or with each finding."""
    steps = account.steps
    if not steps:
        return {}
    if steps[0].verb == "found":
        assert account.diagnosis is not None
        return {"findings": findings(account.diagnosis.findings, account.noise_floor)}
    fits = [steps[0].before, *(step.after for step in steps)]
    held_out = [fit.rmse_held_out for fit in fits]
    known = [error for error in held_out if error is not None]
    return {
        "errors": falling_error(
            [fits[0].model.spec, *(step.label for step in steps)],
            known if len(known) == len(fits) else [fit.rmse for fit in fits],
            account.final.model.torque_unit,
            noise_floor=account.noise_floor,
            held_out=len(known) == len(fits),
        )
    }


def robot_plots(found: RobotFit) -> dict[str, figure]:
    """Two figures a joint, by their captions; all joints share their samples and time."""
    samples = robot_samples(found)
    plots: dict[str, figure] = {}
    time_range: object = None
    for k, joint in enumerate(samples.joints):
        plots[f"Joint {joint.name}: friction against velocity"] = joint_friction(samples, k)
        residual = joint_residual(samples, k, x_range=time_range)
        time_range = residual.x_range
        plots[f"Joint {joint.name}: residual over time"] = residual
    return plots
