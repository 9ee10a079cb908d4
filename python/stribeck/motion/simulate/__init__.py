"""Joints in motion: a friction model on an inertia, in open or closed loop.

`simulate` moves it; `Joint` says what is moved, `Torque`, `Follow` or `Pull` by what. `validate`
holds a simulated motion against a measured one.
"""
