"""Errors of the identified parameters: covariance, bootstrap, profiles, what is determined."""
