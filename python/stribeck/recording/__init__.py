"""Recordings: any supported file to one checked table of SI channels."""

from .load import read, read_all
from .recording import Column, Recording
from .scan import FileColumn, Table, scan

__all__ = ["Column", "FileColumn", "Recording", "Table", "read", "read_all", "scan"]
