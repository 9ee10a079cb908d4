"""Export to C in fixed point, with an error bound over the operating box."""
