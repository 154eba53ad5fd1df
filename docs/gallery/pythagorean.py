"""Masses 3, 4 and 5 fall from the corners of a triangle."""

import matplotlib.pyplot as plt
import numpy as np

import visviva as vv

scene = vv.problems.pythagorean().scene
out = scene.run(t=np.linspace(0.0, 20.0, 4001), rtol=1e-12)
with plt.style.context(vv.plot_style()):
    fig, ax = plt.subplots(figsize=(5, 5), layout="constrained")
for body, mass in enumerate(scene.particles.mass):
    ax.plot(*out.position[:, body, :2].T, lw=0.8, label=f"mass {mass:g}")
ax.set(xlabel="x", ylabel="y", aspect="equal", title="The Pythagorean problem to t = 20")
ax.legend()
