"""Projects: interactive diagnosis, with all models of one recording in one file.

`source` has the data and the reading options, `kept` a stored model, `findings` the results of a
diagnosis, `node` a model with its origin, `tree` all nodes, `project` the operations, `sides` the
comparison of two nodes; `write` and `read` handle the TOML file.
"""
