"""Friction compensation: how much better a joint follows, and how much of it is safe to cancel.

`compensate` moves a joint along a trajectory without and with compensation, `teach` lets a hand
guide it, and `largest_factor` proves which share of the friction can be cancelled without ever
cancelling more than there is.
"""
