"""The transmission between two encoders: stiffness, backlash and hysteresis of its windup."""
