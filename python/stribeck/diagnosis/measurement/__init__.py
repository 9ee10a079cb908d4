"""What measuring does to the torque of a model: causes that friction effects may imitate.

Each file has one cause, as columns that a diagnosis adds to the linearised model. They are no
effects of the catalog: they take any size and sign, and serve as the alternative that a friction
effect must beat.
"""
