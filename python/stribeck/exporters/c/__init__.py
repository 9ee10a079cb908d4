"""Export to self-contained C99: header, source, test vectors, self-test."""
