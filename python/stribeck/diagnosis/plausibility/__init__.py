"""Rules that a finding must obey to be claimed: its values must be physically possible."""
