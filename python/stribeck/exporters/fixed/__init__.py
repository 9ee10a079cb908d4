"""C in fixed point, with a bound of the error over the operating box."""
