"""Least squares of one model on one recording: the parts that `stribeck.fit` puts together."""
