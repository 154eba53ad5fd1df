"""A ball thrown with drag: the best angle is below 45 degrees."""

import matplotlib.pyplot as plt
import numpy as np

import visviva as vv

with plt.style.context(vv.plot_style()):
    fig, ax = plt.subplots(figsize=(7, 3.6), layout="constrained")
for angle in (25, 35, 40, 45, 55):
    up = np.radians(angle)
    ball = vv.Particles([0.145], [[0.0, 0.0, 0.0]], [[40.0 * np.cos(up), 0.0, 40.0 * np.sin(up)]])
    ground = vv.events.plane([0, 0, 0], [0, 0, 1.0], direction=-1, terminal=True)
    scene = vv.Scene(ball, vv.UniformField([0, 0, -9.81]), vv.QuadraticDrag(0.0008))
    out = scene.run(t=np.linspace(0.0, 10.0, 1001), method="dop853", events=[ground])
    ax.plot(out.position[:, 0, 0], out.position[:, 0, 2], label=f"{angle}°")
ax.set(xlabel="x (m)", ylabel="z (m)", ylim=(0, None), aspect="equal", title="A baseball at 40 m/s, with drag")
fig.legend(loc="outside right upper", title="thrown at")
