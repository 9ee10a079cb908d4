"""Least squares of one model on one recording: the parts of `stribeck.fit`."""
