"""Whether the channels of a recording agree with each other: units, signs, joints and clocks.

One check per file; each returns a `Check` or None where its channels are absent. No check fits a
friction law.
"""
