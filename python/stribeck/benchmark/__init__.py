"""How far the diagnosis can be trusted, on recordings with a known truth.

``open_loop`` and ``closed_loop`` make the recordings; they share no formula with the laws or with
each other. ``cases`` lists what is asked, ``answer`` asks, ``judge`` says what an answer is worth,
``score`` counts, ``text`` and ``figures`` show it; ``run`` and ``store`` keep it going and keep it.
``coverage`` looks at the intervals of parameters under noise with memory.
"""
