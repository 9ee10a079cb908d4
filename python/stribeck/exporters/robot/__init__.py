"""Export of a robot: torques of all joints, from rigid bodies and friction."""
