"""An effect in synthetic recordings: its residual, and what it is mistaken for."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field

import stribeck as sb
from matplotlib.figure import Figure
from stribeck.effect.describe import base_of
from stribeck.effect.registry import of_catalog
from stribeck.motion.generate.hidden import generate
from stribeck.report.finding import finding_panel, legend_of_panel
from stribeck.report.style import new_figure, style

#: One recording for each seed; the picture is of the first.
SEEDS, SECONDS, RATE = (1, 2, 3, 4, 5, 6), 120.0, 100.0
#: Inches.
SIZE = (6.4, 3.5)


@dataclass
class Example:
    """An effect that was hidden in one recording for each seed, and what `diagnose` said.

    Attributes
    ----------
    first
        In how many of the recordings it is the first finding, or is tied with it.
    ties, instead
        In how many each other effect is indistinguishable from it; passes every test in its place.
    """

    effect: str
    first: int = 0
    ties: Counter[str] = field(default_factory=Counter)
    instead: Counter[str] = field(default_factory=Counter)
    where: str = ""
    errors: tuple[float, float, float] = (0.0, 0.0, 0.0)
    unit: str = ""
    figure: Figure | None = None


def example(effect: str) -> Example:
    """Hide an effect in a recording for each seed, and diagnose."""
    made = Example(effect)
    for seed in SEEDS:
        frame, truth = generate([*base_of(effect), effect], seed=seed, seconds=SECONDS, rate=RATE)
        before = sb.fit("+".join(["coulomb", *base_of(effect)]), sb.read(frame))
        said = sb.diagnose(before, brief=True)
        named = {row.effect: row for row in (*said.findings, *said.demoted)}
        found = named.get(effect)
        tied = said.findings[0].indistinguishable_from if said.findings else ()
        made.first += bool(said.findings) and effect in (said.findings[0].effect, *tied)
        ties = found.indistinguishable_from if found else ()
        made.ties.update(ties)
        made.instead.update(set(named) - {effect, *ties})
        if seed == SEEDS[0]:
            after = found.fit if found else sb.add(before, effect)
            made.where = of_catalog(effect).where(before, after)
            made.errors = (before.rmse_held_out, after.rmse_held_out, truth["noise_rms"])
            made.unit = before.model.torque_unit
            made.figure = _picture(effect, before, after)
    return made


def _picture(effect: str, before: sb.Fit, after: sb.Fit) -> Figure:
    figure = new_figure(*SIZE)
    axes = figure.add_subplot()
    style(axes)
    finding_panel(axes, effect, before, after)
    legend_of_panel(figure, axes, effect)
    return figure
