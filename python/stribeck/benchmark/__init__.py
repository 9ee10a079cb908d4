"""How far the diagnosis can be trusted."""
