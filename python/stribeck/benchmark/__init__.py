"""Benchmark of the diagnosis on synthetic recordings whose friction is known.

``open_loop`` and ``closed_loop`` generate the recordings; they share no formula with the laws or
with each other. ``cases`` lists the recordings, ``answer`` runs the diagnosis on one, ``judge``
checks the result, ``score`` computes the statistics, ``text`` and ``figures`` show them; ``run``
runs all cases, and ``store`` writes the results to disk. ``coverage`` tests the confidence
intervals of parameters under autocorrelated noise.
"""
