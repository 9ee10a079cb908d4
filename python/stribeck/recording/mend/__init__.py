"""What is mended in a recording, each with a count in its notes; no torque is ever changed."""
