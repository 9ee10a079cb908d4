"""Whole robots: rigid bodies and the friction of every joint, identified together."""
