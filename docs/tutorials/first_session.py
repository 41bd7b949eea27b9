# %% [markdown]
# # A first session
#
# This tutorial runs a session, opens it, and looks at its data. You need the program built by `./dev build`, and no
# device:
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
# A simulated person has done five lifts. The results are in tables:

# %%
print(session.trials[["trial_num", "perturbation", "outcome", "peak_grip_N"]])
print(session.lifts[["trial_num", "lift", "preload_s", "loading_s", "static_grip_N", "safety_margin"]])

# %% [markdown]
# The units are in the columns' names and in `attrs`, which also explains the columns:

# %%
print(session.lifts.attrs["meanings"]["safety_margin"])

# %% [markdown]
# Quantities that were recorded a thousand times a second are arrays. Here are the block's height and the grip force:

# %%
figure, (above, below) = plt.subplots(2, sharex=True, layout="constrained")
above.plot(session.t, 1000 * session["block.position.z"])
above.set_ylabel("height [mm]")
session.plot("grip_force", "load_force", axes=below)
figure.savefig("session.png")

# %% [markdown]
# All lifts, aligned at the moment when the block left the table, by weight: the heavier block is gripped harder.

# %%
axes = session.plot("grip_force", align="lift_off", by="perturbation", before=0.6, after=1.2)
axes.figure.savefig("aligned.png")
