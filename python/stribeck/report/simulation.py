"""A simulated motion in words."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from stribeck.motion.simulate.result import Simulation
    from stribeck.motion.simulate.validation import Validation


def simulation_text(simulation: Simulation) -> str:
    """What the motion came to."""
    torque, position = simulation.joint.units
    summary = simulation.to_dict()
    inertia = "kg m2" if position == "rad" else "kg"
    lines = [
        f"{summary['model']} on {simulation.joint.inertia:.4g} {inertia}: "
        f"{summary['seconds']:g} s in {summary['steps']} steps of {summary['step'] * 1e3:g} ms",
        f"  position      {summary['position']['min']:.4g} to {summary['position']['max']:.4g} "
        f"{position}, {summary['position']['end']:.4g} at the end",
        f"  largest speed {summary['largest_speed']:.4g} {position}/s, "
        f"at rest {100.0 * summary['share_at_rest']:.3g} % of the time",
        f"  motor torque  {summary['largest_torque']:.4g} {torque} at most",
    ]
    if summary["tracking_error"] is not None:
        error = summary["tracking_error"]
        lines.append(
            f"  tracking      off by {error['rms']:.4g} {position} RMS, "
            f"{error['largest']:.4g} at most"
        )
    energy = simulation.energy
    lines.append(
        f"  energy        motor {energy['motor']:.4g} J, environment {energy['environment']:.4g} "
        f"J, friction took {energy['friction']:.4g} J (balance: {energy['imbalance']:.1e} J)"
    )
    if simulation.left_out:
        lines.append(f"  left out      {', '.join(simulation.left_out)}: of the measurement")
    return "\n".join(lines)


def validation_text(validation: Validation) -> str:
    """How far the simulated motion is from the measured one."""
    _, position = validation.joint.units
    how = "in closed loop" if validation.closed_loop else "driven by the measured torque alone"
    summary = validation.to_dict()
    lines = [
        f"{summary['model']}, {how}, over {summary['rows']} rows:",
        f"  position off by {summary['position_rmse']:.3g} {position} RMS "
        f"({100.0 * summary['position_relative_error']:.2g} % of its standard deviation), "
        f"{summary['position_largest_error']:.3g} at most",
    ]
    if validation.closed_loop:
        lines.append(f"  torque off by {100.0 * summary['torque_relative_error']:.2g} %")
    for growth in validation.growth:
        lines.append(
            f"  after {growth.seconds:>5g} s  off by {growth.error:.3g} {position}, "
            f"having moved by {growth.way:.3g} (RMS of {growth.starts} starts)"
        )
    return "\n".join(lines)
