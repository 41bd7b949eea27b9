# %% [markdown]
# # Grip and lift: does grip follow weight and friction?
#
# Johansson and Westling (1984) let people lift objects of three weights and three surfaces. The grip force that holds
# an object grows with its weight, and more steeply the more slippery it is, so that the margin against slips remains.
# Simulated people do the same experiment here; with real devices, leave out `simulate`.

# %%
import matplotlib.pyplot as plt
import numpy as np

import dihaptic as dh

session = dh.run(dh.shipped("experiments/grip-and-lift.yaml"), simulate=True, participant="sim-003", seed=3)
lifts = session.lifts.merge(session.trials[["trial_num", "attempt", "condition"]], on=["trial_num", "attempt"])
lifts = lifts[lifts.lift == "complete"]
print(lifts.groupby("condition")[["static_grip_N", "static_load_N", "safety_margin", "grip_load_r"]].mean().round(2))

# %% [markdown]
# Grip force against load force in the hold, by condition. The lines are the least grip that holds: load / (2 x friction)
# with two digits.

# %%
figure, axes = plt.subplots(layout="constrained")
for condition, some in lifts.groupby("condition"):
    axes.plot(some.static_load_N, some.static_grip_N, "o", label=condition)
load = np.linspace(0, lifts.static_load_N.max() * 1.1)
for friction in (0.4, 0.8):
    axes.plot(load, load / (2 * friction), color="#999999", linewidth=0.8)
axes.set_xlabel("load force [N]")
axes.set_ylabel("grip force [N]")
axes.legend(frameon=False, fontsize="small")
figure.savefig("grip-and-load.png")

# %% [markdown]
# Grip force begins to rise before load force, and both rise together: the forces of each lift, aligned at lift-off.

# %%
axes = session.plot("grip_force", "load_force", align="lift_off", before=0.6, after=0.8)
axes.figure.savefig("forces.png")

# %% [markdown]
# The figures of the lifts come from the recorded contacts. If another laboratory has recorded forces but no contacts,
# pass the forces to `find_lift()`. Here the forces of one of these lifts are treated in that way:

# %%
first = lifts.iloc[0]
part = session.between(first.touch_s - 0.5, first.release_s + 0.3)
grip = np.column_stack([session[f"{finger}.normal_force"][part] for finger in session.fingers])
load = np.column_stack([-session[f"{finger}.contact_force.z"][part] for finger in session.fingers])
found = dh.find_lift(grip, load, session[f"{session.info['object']}.position.z"][part], session.tick)
begin = first.touch_s - 0.5
print(f"lift-off by contact {first.lift_off_s:.3f} s, by forces {begin + found['lift_off_s']:.3f} s")
