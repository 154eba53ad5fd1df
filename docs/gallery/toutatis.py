"""Toutatis tumbles: its long axis, and its angular velocity along its own axes."""

import matplotlib.pyplot as plt
import numpy as np

import visviva as vv

data = vv.datasets.toutatis()
t = np.linspace(0.0, 30.0, 3001)
motion = data.motion(t)
axis = vv.rigid.rotate(motion.orientation, [0.0, 0.0, 1.0])
with plt.style.context(vv.plot_style()):
    fig, (left, right) = plt.subplots(1, 2, figsize=(10, 4.2), layout="constrained")
for name, component in zip("xyz", motion.angular_velocity.T, strict=True):
    left.plot(t, np.degrees(component), label=name)
left.set(xlabel="days", ylabel="angular velocity (degrees/day)", title="Along the axes of the body")
left.legend(loc="lower center", bbox_to_anchor=(0.5, 0.15), ncols=3, fontsize="small")
right.plot(np.degrees(np.unwrap(np.arctan2(axis[:, 1], axis[:, 0]))), np.degrees(np.arcsin(axis[:, 2])), lw=0.9)
right.set(
    xlabel="ecliptic longitude (degrees)", ylabel="latitude (degrees)", title="Where the long axis points, 30 days"
)
