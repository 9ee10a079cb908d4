"""A file with all its joints: what is in it, and the sidecar that it needs."""
