"""Simulated arms with a known truth: hidden effects, payloads, intervals."""
