"""Many laws compared on many joints, with tables and figures."""
