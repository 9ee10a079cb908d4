"""Single figures of models on a recording, in the column widths of journals."""
