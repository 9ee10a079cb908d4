"""Passivity: proofs over an operating box that a model gives off no energy, or what breaks it."""
