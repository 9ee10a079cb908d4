"""The residual of a model: the noise floor, and the structure that remains above it."""
