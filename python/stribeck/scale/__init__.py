"""More than one recording, or more data than memory holds."""
