"""The same identification on many robots, joints and days, and what changed between days."""
