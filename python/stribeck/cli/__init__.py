"""The command `stribeck`: options in, results out, no mathematics."""
