"""One file per format: from the bytes of a file to its columns."""
