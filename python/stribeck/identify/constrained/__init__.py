"""Least squares under bounds, ties and conditions, and with priors or a robust loss."""
