"""Friction compensation: the gain in tracking, and the largest safe compensation factor.

`compensate` moves a joint along a trajectory without and with compensation, `teach` simulates
guidance by hand, and `largest_factor` proves how much of the friction can be compensated without
exceeding it.
"""
