# %% [markdown]
# # A first session
#
# A session is run, opened, and looked at. You need what `./dev build` makes, and no device:
#
#     export PYTHONPATH=build/release/python
#     /usr/bin/python3 docs/tutorials/first_session.py
#
# In Jupyter, with jupytext, this file opens as a notebook.

# %%
import matplotlib.pyplot as plt

import dihaptic as dh

session = dh.run(dh.shipped("experiments/first-trials.yaml"), simulate=True, participant="sim-001")
print(session)

# %% [markdown]
# A simulated person has done five lifts. What became of them is in tables:

# %%
print(session.trials[["trial_num", "perturbation", "outcome", "peak_grip_N"]])
print(session.lifts[["trial_num", "lift", "preload_s", "loading_s", "static_grip_N", "safety_margin"]])

# %% [markdown]
# The units are in the columns' names, and in `attrs`; the meanings too:

# %%
print(session.lifts.attrs["meanings"]["safety_margin"])

# %% [markdown]
# What was recorded a thousand times a second is arrays. The block's height, and the force of the grip:

# %%
figure, (above, below) = plt.subplots(2, sharex=True, layout="constrained")
above.plot(session.t, 1000 * session["block.position.z"])
above.set_ylabel("height [mm]")
session.plot("grip_force", "load_force", axes=below)
figure.savefig("session.png")

# %% [markdown]
# All lifts, aligned when the block left the table, by its weight: the heavier block is gripped harder.

# %%
axes = session.plot("grip_force", align="lift_off", by="perturbation", before=0.6, after=1.2)
axes.figure.savefig("aligned.png")
