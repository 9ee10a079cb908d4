"""What a user states about a fit: choices, priors, formulas, the loss."""
