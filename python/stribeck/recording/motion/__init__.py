"""What follows from the motion of a recording: moves, derivatives, lags and excerpts."""
