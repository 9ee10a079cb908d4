"""Held-out blocks other than stretches and runs."""
