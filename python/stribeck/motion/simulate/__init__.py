"""Joints in motion: a friction model on an inertia, in open or closed loop.

`simulate` computes the motion of a `Joint` driven by a `Torque`, `Follow` or `Pull`. `validate`
compares a simulated motion with a measured one.
"""
