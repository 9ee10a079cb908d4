"""Several files, or recordings, as the runs of one recording."""
