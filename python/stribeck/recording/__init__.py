"""Recordings: any supported file to one checked table of SI channels."""
