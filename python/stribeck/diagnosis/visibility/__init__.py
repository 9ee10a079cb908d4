"""How large an effect must be to be seen, and which effects are indistinguishable."""
