# %% [markdown]
# # Your own simulated person
#
# The simulated people of the program grip, adapt and answer as published measurements of people suggest. You can try
# another theory of how people move in a few lines: a person is a class that looks and acts, a hundred times a second.

# %%
import numpy as np

import dihaptic as dh


class Lifter(dh.Person):
    """Goes down, closes the hand until it feels enough, lifts, and puts down."""

    enough = 0.8  # force on a finger with which it lifts [N]

    def __init__(self, aim_mm=10):
        self.aim_mm = aim_mm  # half the aperture that it wants when it holds something: the smaller, the firmer
        self.at = {}
        self.gripped = False

    def act(self, seen):
        height = seen.fingers["thumb"][2]
        closed = self.aim_mm / 1000
        x, z = 0.04, 0.09  # half the aperture, and the height, that it wants [m]
        if seen.state == "lift":
            if abs(seen.felt("thumb")[0]) > self.enough:
                self.gripped = True
            x = closed if self.gripped or height < 0.03 else 0.04
            z = 0.055 if self.gripped else 0.02
        elif seen.state == "hold":
            x, z = closed, 0.055
        elif seen.state == "put down":
            x = closed if height > 0.022 and self.gripped else 0.04
            z = 0.018
            self.gripped = x < 0.02
        else:
            self.gripped = False
        for finger, side in (("thumb", -1), ("index", 1)):
            at = self.at.get(finger, seen.fingers[finger])
            step = np.clip([side * x, 0, z] - at, -0.002, 0.002)
            self.at[finger] = at + step
            self.lead(finger, self.at[finger], step / self.every)


# %%
lifter = Lifter()
session = dh.run(dh.shipped("experiments/first-trials.yaml"), person=lifter, participant="sim-mine")
print(session.trials[["trial_num", "perturbation", "outcome"]])
print(session.lifts[["trial_num", "lift", "static_grip_N", "static_load_N"]])

# %% [markdown]
# Its session was recorded like anybody's. It grips all weights alike, as no real person does:

# %%
axes = session.plot("grip_force", align="lift_off", by="perturbation")
axes.figure.savefig("lifter.png")

# %% [markdown]
# A study of such people is a rehearsal: each person is made from its number, and the table `people` lists its
# attributes. Here each person closes the hand further than the one before, and so grips more firmly:

# %%
study = dh.rehearse(
    dh.shipped("experiments/first-trials.yaml"),
    people=4,
    jobs=2,
    person=lambda number: Lifter(aim_mm=12 - 2 * number),
    out="lifters",
)
grips = study.table("lifts").groupby("id").static_grip_N.mean()
print(study.people.set_index("id")[["aim_mm"]].join(grips))
