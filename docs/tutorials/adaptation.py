# %% [markdown]
# # An adaptation study, rehearsed and fitted
#
# Before you invite anybody, simulated people do the whole study: the display is rotated, then rotated the other way.
# (Simulated people are calibrated on published means; what they show about a new design is a guess.)

# %%
import matplotlib.pyplot as plt
import numpy as np

import dihaptic as dh

study = dh.rehearse(dh.shipped("experiments/rotation-reversal.yaml"), people=2, jobs=2, out="reversal")
trials = study.trials
print(trials.groupby("ppid").trial_num.count())

# %% [markdown]
# Compensation of each person in each trial, in degrees, as the program's report has it (`adaptation.csv`):

# %%
adaptation = study.table("adaptation")
print(adaptation.columns.tolist())
measured = next(column for column in adaptation.columns if column.startswith("compensation"))
figure, axes = plt.subplots(figsize=(9, 4), layout="constrained")
for person, rows in adaptation.groupby("id"):
    axes.plot(rows.trial_num, rows[measured], linewidth=0.8, label=person)
axes.set_xlabel("trial")
axes.set_ylabel("compensation [deg]")
axes.legend(frameon=False)
figure.savefig("compensation.png")

# %% [markdown]
# The two-rate model of each person, and how well its parameters are known:

# %%
for person, rows in adaptation.groupby("id"):
    bias = rows[rows.block == "baseline"][measured].mean()
    fit = dh.fit_two_rate(rows[measured] - bias, rows.perturbation, rows.error_seen == "no")
    low, high = fit.intervals["retention_slow"]
    print(f"{person}: A_slow {fit.retention_slow:.4f} ({low:.4f} to {high:.4f}), B_fast {fit.learning_fast:.3f}, n {fit.n}")

# %% [markdown]
# How many people does the study need? Plot the mean and its standard error for the people who were rehearsed:

# %%
last = adaptation.groupby("id").tail(10).groupby("id")[measured].mean()
print(f"last ten trials: {last.mean():.1f} +- {last.std(ddof=1) / np.sqrt(len(last)):.1f} deg over {len(last)} people")
