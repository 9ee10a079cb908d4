"""Optimal experiment design: motions that show effects which a recording cannot."""
