"""A Rust module for the crate: the model as constants, test vectors, self-test."""
