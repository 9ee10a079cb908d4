"""Parameter sets as the literature prints them: one table (TOML) a source, and their reader."""
