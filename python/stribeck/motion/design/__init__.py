"""Motions that show what a recording does not: optimal experiment design."""
