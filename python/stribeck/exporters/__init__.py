"""Export: a fitted model as a program for the joint's controller."""
