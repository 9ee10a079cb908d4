"""Friction models: a law, its effects, the values of its parameters, and the model file."""
