"""One file an effect: what it needs, how it shows, and in which words."""
