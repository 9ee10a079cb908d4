"""Projects: the loop of diagnosis by hand, with every branch in one file.

The walk through it: `source` is the data and how it was read, `kept` a fitted model as it is
stored, `findings` what a diagnosis said, `node` a model with how it came about, `tree` the nodes,
`project` the verbs, `sides` two nodes beside each other, `write` and `read` the TOML.
"""
