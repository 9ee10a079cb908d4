"""The effects that can be missing from a friction model, one file each.

`NAME.py` stands beside `src/effect/NAME.rs`. The Rust file computes the torque; the Python file
says what a recording must hold to show the effect, how it is described, and how it is generated.
"""
