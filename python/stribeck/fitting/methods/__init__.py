"""Identification methods of the papers.

=================== ================================================== ========================
what                how                                                source
=================== ================================================== ========================
`stribeck.fit`      root mean square error, bounds, 20 random starts   UR5e review, eqs 4-5
`grid_fit`          regression inside a grid, least absolute error     Bittencourt, eqs 5-6
`averaged_points`   half the difference of forward and backward passes Bittencourt, eqs 3-4
`segment_points`    means over constant-speed intervals                Gantry, section 3
`three_step_fit`    temperature, load and presliding one after another Tadese, section V-A
`arm_fit`           inertia and friction of a planar two-joint arm     Indri, section 4.2
=================== ================================================== ========================

`averaged_points` and `segment_points` reduce a recording to steady-state friction points, to which
a law is then fitted.
"""
