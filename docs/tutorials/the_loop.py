# ---
# jupyter:
#   jupytext:
#     text_representation:
#       extension: .py
#       format_name: percent
#   kernelspec:
#     display_name: Python 3
#     language: python
#     name: python3
# ---

# %% [markdown]
# # The loop on a hidden effect
#
# A joint is measured. Its friction is said to be Coulomb and viscous friction. Is that all?
# We make the measurement ourselves, so that the answer is known: dry friction grows with the load.

# %%
import numpy as np
import stribeck as sb

rng = np.random.default_rng(0)
t = np.arange(6000) / 100.0
v = 0.9 * np.cos(0.9 * t) + 0.5 * np.cos(2.3 * t + 1.0)
q = np.sin(0.9 * t) + 0.5 / 2.3 * np.sin(2.3 * t + 1.0)
load = 20.0 * np.sin(q + 0.3)
friction = (3.0 + 0.1 * np.abs(load)) * np.sign(v) + 1.2 * v
joint = sb.Recording.from_columns(
    time=t,
    position=q,
    velocity=v + 1e-4 * rng.standard_normal(t.size),
    torque=load + friction + 0.05 * rng.standard_normal(t.size),
    load_torque=load,
)
joint

# %% [markdown]
# ## Compare
#
# The simplest law is fitted. A selection in one figure is marked in the others: select a reversal
# over time and find it against velocity.

# %%
simple = sb.fit("coulomb", joint)
simple

# %% [markdown]
# ## Where does it fail?
#
# The comparison splits the error by regime. The more complex LuGre law fits no better: what is
# missing is not a matter of presliding.

# %%
sb.compare([simple, sb.fit("lugre", joint, starts=5)], joint)

# %% [markdown]
# ## What is missing?
#
# Every known effect is tried on held-out data. Those that this motion cannot tell apart are named
# together.

# %%
diagnosis = sb.diagnose(simple)
diagnosis

# %% [markdown]
# ## Add it, until the rest is noise

# %%
improvement = sb.improve("coulomb", joint)
improvement

# %%
effects = [step.finding.effect for step in improvement.steps]
assert effects == ["load"], effects
improvement.final.rmse_held_out / improvement.base.rmse_held_out

# %% [markdown]
# The noise that we added has an RMS of 0.05 N m; the held-out error of the final model is the same.
# `stribeck report` writes all this as one page.
