"""A satellite goes round Earth and Moon on Arenstorf's periodic orbit."""

import matplotlib.pyplot as plt
import numpy as np

import visviva as vv

problem = vv.problems.arenstorf()
out = problem.scene.run(t=np.linspace(0.0, problem.t_end, 4001), rtol=1e-12)
earth, moon, satellite = out.position[:, 0], out.position[:, 1], out.position[:, 2]
along = (moon - earth) / np.linalg.norm(moon - earth, axis=1)[:, None]
from_center = satellite - out.center_of_mass
x = (from_center * along).sum(axis=1)
y = along[:, 0] * from_center[:, 1] - along[:, 1] * from_center[:, 0]
with plt.style.context(vv.plot_style()):
    fig, ax = plt.subplots(figsize=(6, 5), layout="constrained")
ax.plot(x, y, lw=1.2)
for name, body in (("Earth", earth), ("Moon", moon)):
    ax.plot(((body - out.center_of_mass) * along).sum(axis=1)[0], 0.0, "o", label=name)
ax.set(xlabel="towards the Moon", ylabel="across", aspect="equal", title="Arenstorf's orbit, turning with the Moon")
ax.legend()
