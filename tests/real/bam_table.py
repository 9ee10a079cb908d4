"""Print the README's table of the servo laws on the XL330 pendulum, from running their fits.

python tests/real/bam_table.py          # needs ../shared/data; about a minute
"""

from __future__ import annotations

import argparse
import time
from pathlib import Path

import numpy as np
import stribeck as sb
from numpy.typing import NDArray
from scipy.signal import butter, sosfiltfilt
from stribeck.fitting.result import Fit

ROOT = Path(__file__).resolve().parents[2]
DATA = "../shared/data/bam_xl330/xl330_pendulum.parquet"
SIDECAR = "tests/sidecars/bam_xl330_voltage.sidecar.toml"
LAWS = ("bam_m1", "bam_m2", "bam_m3", "bam_m4", "bam_m5", "bam_m6")
#: Band of the figures that leave out what no friction explains: the voltage's ripple.
BAND = 5.0
#: A lower speed has no certain direction: its sensor's steps are 0.024 rad/s and 20 ms late.
SLOW = 0.2

Rows = NDArray[np.bool_]


def rms(values: NDArray[np.float64]) -> float:
    """Root mean square."""
    return float(np.sqrt(np.mean(values**2)))


def r2(fit: Fit, rows: Rows) -> float:
    """Share of the voltage's variance on `rows` that the held-out prediction explains."""
    voltage = fit.recording.torque[rows]
    spread = np.mean((voltage - voltage.mean()) ** 2)
    return 1.0 - rms(fit.held_out_residual[rows]) ** 2 / float(spread)


def slow_part(recording: sb.Recording, values: NDArray[np.float64]) -> NDArray[np.float64]:
    """What lies below `BAND`, without phase, run by run."""
    low_pass = butter(4, BAND, fs=recording.rate_hz, output="sos")
    runs = [np.flatnonzero(recording.run == run) for run in range(recording.runs)]
    return np.concatenate([sosfiltfilt(low_pass, values[rows]) for rows in runs])


def parameters(fit: Fit) -> str:
    """Identified values, and what is zero or cannot be told."""
    said = [
        f"{e.symbol} {e.value:.3g}" + ("" if e.stderr is None else f" ± {e.stderr:.1g}")
        for e in fit.estimates.values()
        if e.identifiable and not (e.at_bound and e.value == e.lower)
    ]
    zero = [e.symbol for e in fit.estimates.values() if e.at_bound and e.value == e.lower]
    hidden = [e.symbol for e in fit.estimates.values() if not e.identifiable and not e.at_bound]
    return (
        ", ".join(said)
        + (f"; {', '.join(zero)} = 0" if zero else "")
        + (f"; **not identifiable: {', '.join(hidden)}**" if hidden else "")
    )


def fitted(spec: str, recording: sb.Recording) -> tuple[Fit, float]:
    """A fit and how long it took, held-out refits included [s]."""
    began = time.perf_counter()
    fit = sb.fit(spec, recording)
    return fit, time.perf_counter() - began


def main() -> None:
    """Fit every law, each gain held out in turn, and print the tables."""
    argparse.ArgumentParser(description=__doc__).parse_args()
    path, sidecar = ROOT / DATA, ROOT / SIDECAR
    whole = sb.read(path, sidecar=sidecar, hold_out="kp")
    driven = whole.moving & whole.enabled
    off = whole.moving & ~whole.enabled
    sure = driven & (np.abs(whole.velocity) > SLOW)
    gains = [whole.moving & whole.enabled & (whole.block == k) for k in range(whole.block_count)]
    print(
        f"Servo on: {driven.sum()} rows, off: {off.sum()}; each gain predicted from the others.\n\n"
        "| law | held-out error on, off [V] | lowest to highest gain [V] | R² on "
        f"| R² on, above {SLOW} rad/s | s |\n|---|---|---|---|---|---|"
    )
    fits = {}
    for law in LAWS:
        fit, seconds = fitted(law, whole)
        fits[law] = fit
        error = fit.held_out_residual
        print(
            f"| `{law}` | {rms(error[driven]):.3f}, {rms(error[off]):.3f} | "
            f"{', '.join(f'{rms(error[rows]):.2f}' for rows in gains)} | {r2(fit, driven):.4f} | "
            f"{r2(fit, sure):.4f} | {seconds:.0f} |",
            flush=True,
        )
    print("\nIdentified from all rows (N m, rad, s, A, V):\n")
    for law, fit in fits.items():
        print(f"- `{law}`: {parameters(fit)}")
    print("\nFrom the rows with the servo on alone:\n")
    on = sb.read(path, sidecar=sidecar, where="torque_enable")
    for law in ("bam_m1", "bam_m3"):
        fit, _ = fitted(law, on)
        print(f"- `{law}`: {parameters(fit)}")
        for estimate in fit.estimates.values():
            if estimate.why is not None:
                print(f"  - {estimate.symbol}: {estimate.why}")
    print(
        f"\nFriction proportional to the load takes the place of Coulomb friction (servo on, above "
        f"{SLOW} rad/s, all rows fitted, both sides below {BAND:g} Hz):\n"
    )
    for spec in ("bam_m1", "bam_m3"):
        fit = fits[spec]
        coulomb = fit.estimates["coulomb_friction"].value
        voltage, left = (slow_part(whole, x)[sure] for x in (whole.torque, fit.residual))
        share = 1.0 - rms(left) ** 2 / float(np.var(voltage))
        print(f"- `{spec}`: R² {share:.3f}, Coulomb friction {coulomb:.4f} N m")


if __name__ == "__main__":
    main()
