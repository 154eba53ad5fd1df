"""Seven stars in a plane: the Pleiades problem, with its close encounters."""

import matplotlib.pyplot as plt
import numpy as np

import visviva as vv

problem = vv.problems.pleiades()
out = problem.scene.run(t=np.linspace(0.0, problem.t_end, 2001), rtol=1e-12)
with plt.style.context(vv.plot_style()):
    fig, ax = plt.subplots(figsize=(5.2, 5.4), layout="constrained")
for body in range(7):
    (line,) = ax.plot(*out.position[:, body, :2].T, lw=1.0, label=f"mass {out.scene.particles.mass[body]:g}")
    ax.plot(*out.position[0, body, :2], "o", ms=4, color=line.get_color())
ax.set(xlabel="x", ylabel="y", aspect="equal", title=f"The Pleiades problem to t = {problem.t_end:g}")
ax.legend(loc="upper left", bbox_to_anchor=(1.02, 1.0), fontsize="small")
