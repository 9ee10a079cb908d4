"""Coverage of 95 % intervals by every kind of errors, for the table in docs/uncertainty.md.

    python tests/studies/intervals.py [--recordings 200] [--errors robust --errors profile ...]

The recordings are those of ``stribeck benchmark diagnosis --only coverage``. One line per
correlation of the noise and kind of errors: the share of intervals that contain the true value, the
smallest share of a single parameter, and seconds per fit.
"""

from __future__ import annotations

import tempfile
import time
from collections import Counter
from pathlib import Path

import click
from stribeck.benchmark.cases import CORRELATIONS, FIRST_SEED
from stribeck.benchmark.coverage import autoregressive_recording
from stribeck.fitting.fit import fit
from stribeck.identify.errors.estimates import ERRORS, Errors
from stribeck.recording.load import read

SPECS = {"coulomb": "coulomb", "stribeck": "coulomb+stribeck"}


@click.command()
@click.option("--recordings", default=200, show_default=True)
@click.option("--errors", "kinds", type=click.Choice(ERRORS), multiple=True, default=ERRORS)
def main(recordings: int, kinds: tuple[Errors, ...]) -> None:
    for correlation in CORRELATIONS:
        for kind in kinds:
            click.echo(line(correlation, kind, recordings))


def line(correlation: float, kind: Errors, recordings: int) -> str:
    covered: Counter[str] = Counter()
    total: Counter[str] = Counter()
    seconds = 0.0
    for k in range(recordings):
        law = tuple(SPECS)[k % 2]
        frame, truth = autoregressive_recording(law, FIRST_SEED + k, correlation)
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "recording.parquet"
            frame.write_parquet(path)
            recording = read(path)
        began = time.perf_counter()
        fitted = fit(SPECS[law], recording, starts=3, errors=kind)
        seconds += time.perf_counter() - began
        for name, value in truth.items():
            low, high = fitted.estimates[name].ci95 or (value, value)
            total[f"{law}: {name}"] += 1
            covered[f"{law}: {name}"] += low < value < high
    least = min(total, key=lambda name: covered[name] / total[name])
    return (
        f"{correlation:<5g} {kind:<12} {100.0 * covered.total() / total.total():5.1f} %   "
        f"least {100.0 * covered[least] / total[least]:5.1f} % ({least})   "
        f"{seconds / recordings:.2f} s"
    )


if __name__ == "__main__":
    main()
