"""Passivity: proofs over an operating box that a model gives off no energy, or what breaks it."""

from __future__ import annotations

from stribeck.passivity.certificate import Certificate, Counterexample, Margin
from stribeck.passivity.check import check

__all__ = ["Certificate", "Counterexample", "Margin", "check"]
