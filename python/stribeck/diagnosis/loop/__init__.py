"""Adding effects to a model: one by hand, or all that pass the test one after another."""
