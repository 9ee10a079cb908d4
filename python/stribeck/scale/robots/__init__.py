"""Recordings of whole robots that are larger than memory."""
