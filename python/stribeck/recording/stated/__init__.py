"""What a user states about a file: options, the sidecar, and both together."""
