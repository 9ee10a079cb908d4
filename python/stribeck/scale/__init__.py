"""Many recordings, and recordings larger than memory."""
