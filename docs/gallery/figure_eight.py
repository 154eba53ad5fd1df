"""Three equal bodies chase each other along one figure eight."""

import matplotlib.pyplot as plt
import numpy as np

import visviva as vv

problem = vv.problems.figure_eight()
out = problem.scene.run(t=np.linspace(0.0, problem.t_end, 400), rtol=1e-12)
fig, ax = plt.subplots(figsize=(6, 3.2), layout="constrained")
ax.plot(*out.position[:, 0, :2].T, lw=1.5)
ax.plot(*out.position[0, :, :2].T, "o", color="C1")
ax.set(xlabel="x", ylabel="y", aspect="equal", title="The figure eight")
