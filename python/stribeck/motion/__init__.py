"""Joints in motion: simulated, compensated, planned, generated."""
