"""What every other room builds on: errors, version, units, files, processes."""
