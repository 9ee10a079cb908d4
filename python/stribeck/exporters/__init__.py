"""Export of a model as a program for the controller of a joint."""
