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
# # A whole robot
#
# All six joints of a UR10e move at once. The rigid bodies and the friction of every joint are
# identified together. `STRIBECK_DATA` names the folder of the data sets.

# %%
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

data = Path(os.environ.get("STRIBECK_DATA", "../shared/data")) / "ur10e_robot"

# %% [markdown]
# The robot is described by its Denavit-Hartenberg table; drive gains turn currents into torques.

# %%
rows = [
    (0.0, 0.1807, 90.0, 10.0),
    (-0.6127, 0.0, 0.0, 10.6956),
    (-0.57155, 0.0, 0.0, 8.4566),
    (0.0, 0.17415, 90.0, 9.0029),
    (0.0, 0.11985, -90.0, 9.48),
    (0.0, 0.11655, 0.0, 10.1232),
]
robot = Path(tempfile.mkdtemp()) / "ur10e.toml"
robot.write_text(
    """kind = "robot"
name = "UR10e"
convention = "standard"

[columns]
time = "t_s"
position = "q_rad_{number}"
velocity = "qd_radps_{number}"
current = "i_A_{number}"
"""
    + "".join(
        f"\n[[joint]]\na = {a}\nd = {d}\nalpha_deg = {alpha}\ndrive_gain = {gain}\n"
        for a, d, alpha, gain in rows
    )
)


def stribeck(*words: object) -> str:
    command = [sys.executable, "-m", "stribeck", "robot", *map(str, words)]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


# %%
print(stribeck("show", robot))

# %% [markdown]
# ## Fit two runs, and judge the model on a third
#
# The ordinary model has Coulomb and viscous friction and an offset on each joint.

# %%
runs = [data / "u14.parquet", data / "u8.parquet"]
options = ["--robot", robot, "--cutoff", 6, "--evaluate", data / "u12.parquet"]
print(stribeck("fit", *runs, *options))

# %%
found = json.loads(stribeck("fit", *runs, *options, "--json"))
assert len(found["joints"]) == 6
[(joint["joint"], joint["model"], joint["relative_residual"]) for joint in found["joints"]]
