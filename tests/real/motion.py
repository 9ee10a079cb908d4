"""Print the README's table of simulated against measured motion, and draw its figure.

python tests/real/motion.py [FIGURE.png]          # needs ../shared/data
"""

from __future__ import annotations

import sys
from pathlib import Path

import polars as pl
import stribeck as sb
from stribeck.base.files import save_figure
from stribeck.motion.simulate.drive import Controller
from stribeck.motion.simulate.validation import validate, validate_closed_loop

ROOT = Path(__file__).resolve().parents[2]
EMPS = ROOT.parent / "shared" / "data" / "emps"
SPECS = ("coulomb+offset", "coulomb+direction", "coulomb+direction+stribeck+presliding")
#: Gains of the drive: 1/s, V s/m, and N/V (Janot, Gautier and Brunot 2019).
POSITION_GAIN, VELOCITY_GAIN, FORCE_PER_VOLT = 160.18, 243.45, 35.15


def recording(name: str) -> sb.Recording:
    """One of the two recordings."""
    sidecar = ROOT / "tests" / "sidecars" / f"{name}.sidecar.toml"
    return sb.read(str(EMPS / f"{name}.parquet"), sidecar=str(sidecar))


def main() -> None:
    """Fit each model to the first recording, simulate both, open and closed loop."""
    fitted_on, other = recording("emps"), recording("emps_pulses")
    controller = Controller.cascade(POSITION_GAIN, VELOCITY_GAIN * FORCE_PER_VOLT)
    desired = pl.read_parquet(EMPS / "emps.parquet")["q_ref_m"].to_numpy()
    first = "| model | error after 0.1, 0.3, 1, 3 s | over 24.8 s "
    print(f"{first}| with force pulses | closed loop |")
    print("|---|---|---|---|---|")
    for spec in SPECS:
        fit = sb.fit(spec, fitted_on)
        alone, pulses = validate(fit, fitted_on), validate(fit, other)
        closed = validate_closed_loop(fit, fitted_on, desired, controller)
        growth = ", ".join(f"{1e3 * g.error:.2g}" for g in alone.growth if g.seconds <= 3.0)
        print(
            f"| `{spec}` | {growth} mm | {100 * alone.relative_error:.2g} % | "
            f"{100 * pulses.relative_error:.2g} % | position {100 * closed.relative_error:.2g} %, "
            f"force {100 * closed.relative_torque_error:.2g} % |",
            flush=True,
        )
        if spec == "coulomb+direction" and len(sys.argv) > 1:
            save_figure(alone.plot(), sys.argv[1])


if __name__ == "__main__":
    main()
