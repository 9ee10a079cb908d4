"""The channels of one joint: its samples, units, loads, drive and second encoder."""
