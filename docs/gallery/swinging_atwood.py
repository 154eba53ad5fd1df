"""A swinging weight and its counterweight: integrable for M = 3 m, and not for others."""

import matplotlib.pyplot as plt
import numpy as np

import visviva as vv

with plt.style.context(vv.plot_style()):
    fig, panels = plt.subplots(1, 3, figsize=(10, 4), layout="constrained")
for ax, ratio in zip(panels, (2.0, 3.0, 4.5), strict=True):
    system = vv.systems.swinging_atwood(counterweight=ratio, position=[1.0, 1.5])
    r, theta = system.run(t=np.linspace(0.0, 20.0, 6001)).position.T
    ax.plot(r * np.sin(theta), -r * np.cos(theta), lw=0.6)
    ax.set(xlabel="x", ylabel="height", aspect="equal", title=f"M = {ratio:g} m")
