"""Passivity: proofs over an operating box that a model generates no energy, or a counterexample."""
