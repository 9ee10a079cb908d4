"""The search for the values of a model: algorithms, starts, hops, the best of several ends."""
