"""Synthetic recordings: one joint with chosen hidden effects, or a robot arm like a UR5e."""

from __future__ import annotations

from stribeck.generate.demo import DEMO, demo_path, demo_recording
from stribeck.generate.files import file_bytes, sidecar_text
from stribeck.generate.hidden import generate
from stribeck.generate.motion import JOINTS, plan_motion

__all__ = [
    "DEMO",
    "JOINTS",
    "demo_path",
    "demo_recording",
    "file_bytes",
    "generate",
    "plan_motion",
    "sidecar_text",
]
