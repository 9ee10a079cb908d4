"""Self-contained pages: their sections, equations and figures, one file for each kind of result."""
