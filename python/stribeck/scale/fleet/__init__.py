"""Many robots, joints and days: the same work on each, and what changed."""
