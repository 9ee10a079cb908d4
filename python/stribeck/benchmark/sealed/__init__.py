"""Nuisances on which the diagnosis was not developed.

They were written before it was made robust to those of `nuisances`, and serve to score it once.
"""
