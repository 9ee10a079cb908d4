"""Recordings: any supported file to one checked table of SI channels."""

from .recording import Column, FileColumn, Recording, Table, read, read_all, scan

__all__ = ["Column", "FileColumn", "Recording", "Table", "read", "read_all", "scan"]
