"""A file as a table: its columns, cells and formulas over them."""
