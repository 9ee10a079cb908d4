"""Instrumental variables: the motion that the controller asked for, and tests by it."""
