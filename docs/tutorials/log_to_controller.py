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
# # From a log to a controller
#
# A log becomes a model, the model is proved passive, its compensation is tried in simulation, and
# one step of it becomes C for the controller.

# %%
import subprocess
import tempfile
from pathlib import Path

import numpy as np
import stribeck as sb

rng = np.random.default_rng(1)
t = np.arange(8000) / 200.0
v = 0.7 * np.cos(0.8 * t) + 0.25 * np.cos(2.1 * t + 0.4)
truth = sb.model("bittencourt_a", a1=2.0, a2=1.0, a3=0.08, a4=2.0, a5=0.6)
torque = truth.torque(v) + 0.02 * rng.standard_normal(t.size)
log = sb.Recording.from_columns(
    time=t,
    velocity=v + 1e-4 * rng.standard_normal(t.size),
    torque=torque,
    load_torque=np.zeros_like(t),
)

# %% [markdown]
# ## Identify

# %%
fit = sb.fit("coulomb+stribeck", log)
fit

# %% [markdown]
# ## Is it safe?
#
# A friction model that generates energy can make a compensated joint unstable. The proof covers
# every motion within the operating box, which is that of the log unless another is given.

# %%
proof = sb.check(fit, box={"velocity": (-1.0, 1.0)})
assert proof.passive
proof

# %% [markdown]
# ## What does compensation bring?
#
# The joint of the simulation has the true friction, the controller has the identified model.

# %%
from stribeck.motion.simulate.trajectory import Quintic

tracking = sb.compensate(
    truth,
    sb.Joint.revolute(0.5),
    Quintic(0.0, 1.0, 2.0),
    [sb.Compensator(fit.model, 0.8, feedback=False)],
)
tracking

# %% [markdown]
# ## C for the controller
#
# The self-test compares the compiled program with the numbers of Python, bit by bit.

# %%
folder = Path(tempfile.mkdtemp())
made = sb.export(fit.model, "c", folder)
made

# %%
sources = sorted(str(path) for path in folder.glob("*.c"))
program = folder / "self_test"
subprocess.run(["cc", "-O2", "-ffp-contract=off", *sources, "-o", str(program)], check=True)
subprocess.run([str(program)], check=True).returncode
