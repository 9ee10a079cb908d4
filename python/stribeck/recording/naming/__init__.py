"""What the names of columns say: channels, units, joints, and what unread columns may hold."""
