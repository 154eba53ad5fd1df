"""Three equal bodies chase each other along one figure eight."""

import matplotlib.pyplot as plt
import numpy as np

import visviva as vv

problem = vv.problems.figure_eight()
out = problem.scene.run(t=np.linspace(0.0, problem.t_end, 400), rtol=1e-12)
with plt.style.context(vv.plot_style()):
    fig, ax = plt.subplots(figsize=(6, 3.2), layout="constrained")
ax.plot(*out.position[:, 0, :2].T, lw=1.5)
ax.plot(*out.position[0, :, :2].T, "o")
ax.set(xlabel="x", ylabel="y", aspect="equal", title="The figure eight")
