"""From the channels of one joint to a checked recording."""
