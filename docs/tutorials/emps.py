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
# # The EMPS benchmark
#
# The electro-mechanical positioning system (Janot, Gautier, Brunot 2019) is a cart on a screw,
# 24 s at 1 kHz. Its authors identify mass, viscous and Coulomb friction and an offset:
# 95.1 kg, 203.5 N s/m, 20.4 N and -3.2 N. `STRIBECK_DATA` names the folder of the data sets.

# %%
import os
from pathlib import Path

import stribeck as sb

data = Path(os.environ.get("STRIBECK_DATA", "../shared/data")) / "emps"
cart = sb.read(
    data / "emps.parquet",
    joint_kind="prismatic",
    map={"time": "t_s", "position": "q_m", "torque": "force_N"},
)
cart

# %%
fit = sb.fit("coulomb+offset", cart)
fit

# %% [markdown]
# The parameters are those of the authors. Is the model complete?

# %%
improvement = sb.improve(fit.model, cart, starts=5)
improvement

# %% [markdown]
# Friction differs between the two directions. On the second file, which nothing was fitted to, the
# model with the direction predicts better.

# %%
pulses = sb.read(
    data / "emps_pulses.parquet",
    joint_kind="prismatic",
    map={"time": "t_s", "position": "q_m", "torque": "force_N"},
)
before = sb.evaluate(fit.model, pulses).rmse
after = sb.evaluate(sb.fit("coulomb+direction+offset", cart).model, pulses).rmse
assert after < before
before, after
