"""Self-contained C99: header, source, test vectors, self-test."""
