"""Comparison of two nodes."""

from __future__ import annotations

from dataclasses import dataclass

import polars as pl

from stribeck.base.shown import Plotted
from stribeck.diagnosis.compare import Comparison, compare
from stribeck.diagnosis.trials.evidence import Difference, difference
from stribeck.fitting.result import Fit
from stribeck.projects.node import Node
from stribeck.recording.recording import Recording


@dataclass(frozen=True, repr=False)
class Sides(Plotted):
    """Two models of one recording, and whether their held-out errors differ significantly.

    Attributes
    ----------
    nodes
        The two nodes, in the order given.
    better
        Index of the node with the smaller held-out error, 0 or 1.
    difference
        Difference of the held-out squared errors.
    """

    nodes: tuple[Node, Node]
    comparison: Comparison
    better: int
    difference: Difference

    @classmethod
    def of(cls, nodes: tuple[Node, Node], fits: tuple[Fit, Fit], recording: Recording) -> Sides:
        """Compare the fits of two nodes."""
        first, second = (_error(fitted) for fitted in fits)
        better = 0 if first <= second else 1
        return cls(
            nodes, compare(fits, recording), better, difference(fits[1 - better], fits[better])
        )

    def to_dict(self) -> dict[str, object]:
        """The JSON of `stribeck compare`, with the nodes and their difference."""
        return {
            **self.comparison.to_dict(),
            "nodes": [node.number for node in self.nodes],
            "better": self.nodes[self.better].number,
            "standard_errors_between": self.difference.statistic,
        }

    def to_frame(self) -> pl.DataFrame:
        """One row per model and regime."""
        return self.comparison.to_frame()


def _error(fitted: Fit) -> float:
    return fitted.rmse if fitted.rmse_held_out is None else fitted.rmse_held_out
