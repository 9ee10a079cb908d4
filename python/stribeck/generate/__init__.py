"""Synthetic recordings: one joint with chosen hidden effects, or a robot arm like a UR5e."""

from __future__ import annotations

from stribeck.generate.demo import DEMO, demo_path, demo_recording
from stribeck.generate.files import file_bytes, sidecar_text, write_robot
from stribeck.generate.hidden import generate
from stribeck.generate.motion import JOINTS, plan_motion
from stribeck.generate.ur5e import RobotRecording

__all__ = [
    "DEMO",
    "JOINTS",
    "RobotRecording",
    "demo_path",
    "demo_recording",
    "file_bytes",
    "generate",
    "plan_motion",
    "sidecar_text",
    "write_robot",
]
