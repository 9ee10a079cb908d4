"""Forward Euler and the exact step, side by side: print the README's figures and draw its picture.

python tests/studies/forward_euler.py [FIGURE.png]

With table 7 of the UR5e review (joint 1) at its 500 Hz; then over random starts of a fit.
"""

from __future__ import annotations

import math
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
import stribeck as sb
from numpy.typing import NDArray
from stribeck.base.files import save_figure
from stribeck.identify.problem import Problem
from stribeck.identify.scaling import bounds, model_for
from stribeck.identify.search.space import SearchSpace
from stribeck.motion.generate.files import write_robot
from stribeck.motion.generate.ur5e import RobotRecording
from stribeck.report.style import AFTER, BEFORE, new_figure, style, title

Array = NDArray[np.float64]

RATE = 500.0
#: Of the UR5e, rad/s.
FASTEST = math.pi
#: Table 7: the bristle of each law, by symbol.
TABLE_7 = {
    "lugre": {"a1": 102467.0, "a4": 74716.0, "a5": 7.70, "a6": 1002.0, "a7": 0.94},
    "tadese_t": {"a1": 14753.0, "a3": 31.20, "a4": 10.31, "a5": -0.89},
    "dahl": {"a1": 26350.0, "a2": 81.09, "a3": 25.43},
}
#: Speeds at which the picture shows a start from rest, rad/s.
SHOWN = {"lugre": math.pi, "tadese_t": 2.3, "dahl": 3.12}
#: A deflection this often beyond the largest that sliding has is lost.
LOST = 10.0
DRAWS = 500
#: What is left at zero: it adds to the torque and not to the bristle.
BESIDE = ("bristle_damping", "viscous")


def strength(law: str, a: dict[str, float], speed: Array) -> Array:
    """Dry friction `D` at a speed."""
    if law == "lugre":
        return a["a4"] + (a["a5"] - a["a4"]) * np.exp(-(np.abs(speed / a["a6"]) ** a["a7"]))
    if law == "tadese_t":
        return a["a3"] + (a["a4"] - a["a3"]) * np.exp(-((speed / a["a5"]) ** 2))
    return np.full_like(speed, a["a2"])


def euler(law: str, a: dict[str, float], velocity: Array, dt: float) -> Array:
    """The bristle's force after each step, `z+ = z + dt dz/dt` as the review integrates it."""
    dry = strength(law, a, velocity)
    force, forces = 0.0, np.empty_like(velocity)
    exponent = a["a3"] if law == "dahl" else 1.0
    with np.errstate(over="ignore", invalid="ignore"):
        for k, (v, d) in enumerate(zip(velocity, dry, strict=True)):
            gap = 1.0 - math.copysign(1.0, v) * force / d
            force += a["a1"] * v * dt * np.sign(gap) * np.float64(abs(gap)) ** exponent
            forces[k] = force
    return forces


def exact(law: str, a: dict[str, float], velocity: Array, dt: float) -> Array:
    """The bristle's force after each step, stepped exactly."""
    model = sb.model(law)
    own = {p.name: a.get(p.symbol, 1.0) for p in model.parameters}
    own.update({name: 0.0 for name in own if name.startswith(BESIDE)})
    return model.with_values([own[name] for name in model.names]).torque(
        velocity, temperature=30.0, dt=dt
    )


Step = Callable[[str, dict[str, float], Array, float], Array]


def peak(step: Step, law: str, speed: float) -> float:
    """Largest force over the largest in sliding, after a start from rest at a constant speed."""
    a = TABLE_7[law]
    velocity = np.full(100, speed)
    most = strength(law, a, np.linspace(0.0, speed, 200)).max()
    found = np.abs(step(law, a, velocity, 1.0 / RATE)).max() / most
    return float(found) if math.isfinite(found) else math.inf


def limit(law: str) -> tuple[float, float]:
    """Largest `r dt` up to the fastest speed, and the speed above which Euler is lost (or inf)."""
    speeds = np.arange(0.01, FASTEST + 1e-9, 0.01)
    rates = TABLE_7[law]["a1"] * speeds / strength(law, TABLE_7[law], speeds) / RATE
    lost = [s for s in speeds if peak(euler, law, float(s)) > LOST]
    return float(rates.max()), min(lost, default=math.inf)


def recording() -> sb.Recording:
    """The review's Test 2, one cycle of the base joint."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "robot.parquet"
        robot = RobotRecording(test=2, seed=0, repeats=1, every=1, rate=RATE)
        write_robot(robot, path)
        sidecar = Path(f"{path}.sidecar.toml")
        sidecar.write_text(robot.sidecar_text())
        return sb.read(str(path), joint="base", sidecar=str(sidecar))


def lost_shares(law: str, rec: sb.Recording) -> tuple[float, float]:
    """Share of a fit's random starts whose bristle is lost: by Euler, and by the exact step."""
    model = model_for(law, rec)
    lower, upper, start = bounds(model, rec)
    problem = Problem(rec, model, np.flatnonzero(rec.moving))
    space = SearchSpace.of(problem, lower, upper)
    random, symbols = np.random.default_rng(0), [p.symbol for p in model.parameters]
    rows = slice(0, 6000)
    velocity = rec.velocity[rows]
    counts = np.zeros(2)
    for _ in range(DRAWS):
        a = dict(zip(symbols, space.drawn(start, random), strict=True))
        most = strength(law, a, velocity).max()
        for k, step in enumerate((euler, exact)):
            force = np.abs(step(law, a, velocity, 1.0 / RATE)).max()
            counts[k] += not force <= LOST * most
    by_euler, by_exact = counts / DRAWS
    return float(by_euler), float(by_exact)


def draw(path: str) -> None:
    """Starts from rest, and how far torques go by speed."""
    figure = new_figure(9.0, 8.0)
    rows = figure.subplots(3, 2)
    speeds = np.linspace(0.05, FASTEST, 200)
    for (left, right), law in zip(rows, TABLE_7, strict=True):
        velocity = np.full(25, SHOWN[law])
        time = 1e3 * (np.arange(velocity.size) + 1.0) / RATE
        for step, colour, name in ((euler, BEFORE, "forward Euler"), (exact, AFTER, "exact step")):
            torque = step(law, TABLE_7[law], velocity, 1.0 / RATE)
            left.plot(time, torque, ".-", color=colour, lw=1.0, label=name)
            peaks = [peak(step, law, float(s)) for s in speeds]
            right.semilogy(speeds, np.minimum(peaks, 1e12), color=colour, lw=1.4)
        most = strength(law, TABLE_7[law], velocity)[0]
        left.set_ylim(-0.5 * most, 3.0 * most)
        title(left, f"{law}, from rest at {SHOWN[law]:.3g} rad/s")
        left.set_ylabel("torque [N m]")
        title(right, f"{law}, by speed")
        right.set_ylabel("largest / sliding torque")
        right.set_ylim(0.1, 2e12)
        style(left)
        style(right)
    rows[2, 0].set_xlabel("time [ms]")
    rows[2, 1].set_xlabel("speed [rad/s]")
    handles, labels = rows[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper right", ncols=2, frameon=False, fontsize=9)
    save_figure(figure, path)


def main() -> None:
    """Print both comparisons."""
    rec = recording()
    print(
        "| law, table 7 | largest r dt | Euler diverges above | random starts that diverge, Euler "
        "| exact step |"
    )
    print("|---|---|---|---|---|")
    for law in TABLE_7:
        rate, speed = limit(law)
        by_euler, by_exact = lost_shares(law, rec)
        above = f"{speed:.2f} rad/s" if math.isfinite(speed) else "never (it rings)"
        print(
            f"| `{law}` | {rate:.2f} | {above} | {100 * by_euler:.0f} % | {100 * by_exact:.0f} % |",
            flush=True,
        )
    if len(sys.argv) > 1:
        draw(sys.argv[1])


if __name__ == "__main__":
    main()
