"""Export: a fitted model as a program for the joint's controller."""

from __future__ import annotations

from stribeck.export.export import Export, export

__all__ = ["Export", "export"]
