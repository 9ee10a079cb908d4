"""Improvement on a data set: effects found on the samples in memory, errors over all samples."""

from __future__ import annotations

from dataclasses import dataclass

from stribeck.base.shown import Shown
from stribeck.diagnosis.loop.determined import undetermined
from stribeck.diagnosis.loop.improve import Improvement
from stribeck.diagnosis.residual.noise_floor import NoiseFloor
from stribeck.diagnosis.trials.ranking import share_of_unexplained
from stribeck.scale.streaming.result import StreamedFit

__all__ = ["StreamedImprovement"]


@dataclass(frozen=True, repr=False)
class StreamedImprovement(Shown):
    """The steps from a base model to one whose residual is noise.

    Attributes
    ----------
    found
        The improvement on the samples in memory: the effects, their confidence, and where they act.
    fits
        The base model and the model of each step, identified on all samples.
    """

    found: Improvement
    fits: tuple[StreamedFit, ...]

    @property
    def final(self) -> StreamedFit:
        """The last model, identified on all samples."""
        return self.fits[-1]

    def to_dict(self) -> dict[str, object]:
        """The contract's JSON of `stribeck improve`; errors and parameters are from all samples."""
        made = self.found.to_dict()
        floor = self.found.noise_floor
        made["steps"] = [
            {
                **step.to_dict(),
                **before_and_after(before, after, floor),
                "rmse_before": before.rmse,
                "rmse_after": after.rmse,
                "parameters": after.to_dict()["parameters"],
            }
            for step, before, after in zip(self.found.steps, self.fits, self.fits[1:], strict=False)
        ]
        last = self.final.to_dict()
        same = ["model", "rmse", "rmse_held_out", "relative_residual", "parameters"]
        same += ["passive", "determined_combinations"]
        made["final"] = {
            **{key: last[key] for key in same},
            "undetermined": undetermined(self.final.estimates),
        }
        made["rmse_held_out_base"] = self.fits[0].rmse_held_out
        made.update({key: last[key] for key in ("scored", "data", "notes")})
        return made


def before_and_after(
    before: StreamedFit, after: StreamedFit, floor: NoiseFloor
) -> dict[str, float | None]:
    """The held-out errors over all samples without and with an effect, and their comparison."""
    return {
        "rmse_held_out_before": before.rmse_held_out,
        "rmse_held_out_after": after.rmse_held_out,
        "share_of_unexplained": share_of_unexplained(before, after, floor),
    }
