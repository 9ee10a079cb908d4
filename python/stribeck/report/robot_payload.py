"""A payload of a robot, and the drive gains that a known one shows, as text."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from stribeck.report.layout import table
from stribeck.report.numbers import plain

if TYPE_CHECKING:
    from stribeck.robot.drive_gains import DriveGain
    from stribeck.robot.result import Payload


def payload_sentence(payload: Payload, gains: Sequence[DriveGain] = ()) -> str:
    """The mass of a payload with its interval, and what it rests on."""
    low, high = payload.mass_ci95
    rests = "which are taken as exact."
    if gains:
        rests = "here those that were used; the table of drive gains has those that it shows."
    runs = ", ".join(payload.runs)
    return (
        f"Payload in {runs}: {plain(payload.mass, 4)} kg, 95 % interval {plain(low, 4)} to "
        f"{plain(high, 4)} kg. It scales with the drive gains, {rests}"
    )


def drive_gains_rows(gains: Sequence[DriveGain]) -> list[list[str]]:
    """The gain of each drive, from a known payload; the heading first."""
    rows = [["joint", "drive gain", "", "over that used", "95 % interval"]]
    for row in gains:
        if row.ratio is None or row.ci95 is None:
            rows.append([row.joint, "", "", "", "its torque does not show here"])
            continue
        gain, unit = ("", "") if row.gain is None else (plain(row.gain, 4), row.unit)
        interval = " to ".join(f"{end:.4f}" for end in row.ci95)
        rows.append([row.joint, gain, unit, f"{row.ratio:.4f}", interval])
    return rows


def drive_gains_text(gains: Sequence[DriveGain]) -> str:
    """The gain of each drive, from a known payload; empty without one."""
    if not gains:
        return ""
    rows = table(drive_gains_rows(gains), right=[1, 3])
    return f"Drive gains, from the known payload:\n{rows}"
