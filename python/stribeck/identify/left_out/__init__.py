"""Samples that are excluded from every fit: transients, and samples in doubt."""
