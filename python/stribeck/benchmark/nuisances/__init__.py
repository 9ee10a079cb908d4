"""What ordinary benches add to a recording: filters, lags, jitter, vibration, warm-up, scales.

One nuisance per file. Each distorts the channels of a recording that a generator has made, whatever
friction is hidden in it. `table` lists them by name.
"""
