"""Servo actuators: joints of which only the motor's voltage is logged."""
