"""Spheres on a frictionless table: momentum goes from ball to ball."""

import matplotlib.pyplot as plt
import numpy as np

import visviva as vv

rows = [(3.0 + 0.9 * row, 1.02 * (place - row / 2.0)) for row in range(4) for place in range(row + 1)]
place = np.array([(-3.0, 0.05, 0.0), *((x, y, 0.0) for x, y in rows)])
velocity = np.zeros_like(place)
velocity[0, 0] = 4.0
balls = vv.Particles(np.ones(len(place)), place, velocity, radius=0.5)
out = vv.Scene(balls).run(t=np.linspace(0.0, 4.0, 401), method="leapfrog", dt=0.01, collisions="bounce")
with plt.style.context(vv.plot_style()):
    fig, ax = plt.subplots(figsize=(7, 5), layout="constrained")
for ball in range(len(place)):
    (line,) = ax.plot(*out.position[:, ball, :2].T, lw=1.0)
    ax.add_patch(plt.Circle(out.position[-1, ball, :2], 0.5, color=line.get_color(), alpha=0.5))
ax.set(xlabel="x", ylabel="y", aspect="equal", title=f"{len(out.collisions)} collisions, momentum and energy kept")
