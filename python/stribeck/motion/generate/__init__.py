"""Synthetic recordings: one joint with chosen hidden effects, or a robot arm like a UR5e."""
