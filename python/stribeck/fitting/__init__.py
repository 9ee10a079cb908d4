"""Identify a model on a recording."""
