"""Samples that are scored but excluded from every fit: transients, and channels that are late."""
