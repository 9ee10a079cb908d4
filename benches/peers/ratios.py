"""Times of this package and of its peers side by side in one process.

    python3 develop.py peers --bam FOLDER

installs what is compared with and runs this. Each line is the median of interleaved repeats, one
thread. Peers compute the same numbers: that is checked first. BAM's simulator is compared with
where a checkout of its repository (Rhoban/bam) is given.
"""

from __future__ import annotations

import argparse
from tempfile import TemporaryDirectory

import arm
import fits
import laws
import numpy as np
import pendulum
import polars as pl
import servo
import static_laws
import stribeck as sb
from stribeck.identify.scaling import model_for, scaled_parameters
from timing import line

SAMPLES = 30_000
STARTS = 20
DT = 0.002


def expected(law: str, recording: sb.Recording) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The values to expect, which the peers search, and the first start: arrays [p]."""
    rows = scaled_parameters(model_for(law, recording), recording)
    lower, upper = np.array([p.drawn for p in rows]).T
    return lower, upper, np.array([p.start for p in rows])


def velocities(samples: int) -> np.ndarray:
    """A motion that passes slow and fast speeds and reverses."""
    time = DT * np.arange(samples)
    return 0.9 * np.sin(0.7 * time) * np.cos(0.11 * time) + 0.05 * np.sin(6.1 * time)


def model(law: str, values: tuple[float, ...]) -> sb.Model:
    names = [parameter.name for parameter in sb.model(law).parameters]
    return sb.model(law, **dict(zip(names, values, strict=True)))


def compare_laws() -> None:
    many = velocities(1_000_000)
    out, work, own = np.empty_like(many), np.empty_like(many), np.empty_like(many)
    static = model("bittencourt_a", laws.BITTENCOURT_A)
    np.testing.assert_allclose(
        static.torque(many), laws.bittencourt_a(many, laws.BITTENCOURT_A, out, work), rtol=1e-12
    )
    line(
        "bittencourt_a, 1e6 samples",
        "numpy, in place",
        lambda: static.torque(many, out=own),
        lambda: laws.bittencourt_a(many, laws.BITTENCOURT_A, out, work),
        15,
    )
    few = velocities(100_000)
    bristle = model("lugre", laws.LUGRE)
    torque, slopes = laws.lugre_gradient(few, DT, laws.LUGRE)
    own_torque, own_slopes = bristle.torque(few, dt=DT), bristle.gradient(few, dt=DT)
    size = np.abs(slopes).max(axis=0)
    # The first row starts a segment, whose length nobody knows.
    assert np.abs((own_torque - torque)[1000:]).max() < 1e-6 * np.abs(torque).max()
    assert (np.abs(own_slopes - slopes)[1000:] < 1e-6 * size).all()
    line(
        "lugre, exact step, 1e5 samples",
        "numba",
        lambda: bristle.torque(few, dt=DT),
        lambda: laws.lugre(few, DT, laws.LUGRE),
        25,
    )
    line(
        "lugre and 7 derivatives, 1e5 samples",
        "numba",
        lambda: bristle.gradient(few, dt=DT),
        lambda: laws.lugre_gradient(few, DT, laws.LUGRE),
        25,
    )


def recorded(law: str, values: tuple[float, ...]) -> tuple[np.ndarray, np.ndarray, sb.Recording]:
    """Velocity (rad/s), torque with noise (N m), and the recording of both."""
    velocity = velocities(SAMPLES)
    noise = 0.3 * np.random.default_rng(1).standard_normal(SAMPLES)
    torque = np.asarray(model(law, values).torque(velocity, dt=DT)) + noise
    time = DT * np.arange(SAMPLES)
    table = pl.DataFrame({"time": time, "velocity": velocity, "friction_torque": torque})
    with TemporaryDirectory() as folder:
        table.write_parquet(f"{folder}/log.parquet")
        return velocity, torque, sb.read(f"{folder}/log.parquet", joint_kind="revolute")


def compare_fits() -> None:
    for law, values, gradient in (
        ("bittencourt_a", laws.BITTENCOURT_A, laws.bittencourt_a_gradient),
        ("lugre", laws.LUGRE, lambda v, p: laws.lugre_gradient(v, DT, p)),
    ):
        velocity, torque, recording = recorded(law, values)
        lower, upper, _ = expected(law, recording)
        made = []
        their = fits.Slsqp(gradient, velocity, torque, lower, upper, STARTS)
        line(
            f"{law}, {STARTS} starts, {SAMPLES} samples",
            "SciPy SLSQP, analytic gradient" + (" by numba" if law == "lugre" else ""),
            lambda law=law, made=made, recording=recording: made.append(
                sb.fit(law, recording, starts=STARTS)
            ),
            their.run,
            1,
        )
        print(
            f"  {law}: RMS error {made[-1].rmse:.6f} here, {min(their.errors):.6f} by SciPy, "
            f"where {their.at_optimum()} of its {STARTS} starts end"
        )


def compare_one_start() -> None:
    """From a start near the optimum; here held-out error and robust standard errors follow."""
    velocity, torque, recording = recorded("bittencourt_a", laws.BITTENCOURT_A)
    box = expected("bittencourt_a", recording)
    their = fits.Levenberg(laws.bittencourt_a_gradient, velocity, torque, *box)

    def ours() -> float:
        return sb.fit("bittencourt_a", recording, starts=1).rmse

    np.testing.assert_allclose(ours(), their.run(), rtol=1e-4)
    line(
        f"bittencourt_a, 1 start, {SAMPLES} samples",
        "lmfit, analytic gradient",
        ours,
        their.run,
        9,
    )


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser()
    parser.add_argument(
        "--bam", type=servo.checkout, metavar="FOLDER", help="a checkout of Rhoban/bam"
    )
    said = parser.parse_args()
    print("| work | stribeck | peer | ratio |")
    print("|---|---|---|---|")
    compare_laws()
    static_laws.compare_static_laws(velocities(1_000_000))
    compare_fits()
    compare_one_start()
    pendulum.compare_pendulums()
    arm.compare_arms()
    if said.bam is None:
        print(
            "left out: BAM's simulator, because no checkout of Rhoban/bam is given (--bam FOLDER)"
        )
    else:
        servo.compare_simulators(said.bam)


if __name__ == "__main__":
    main()
