"""The planets from the states of JPL's DE405: two years of the inner ones, twelve of the outer ones."""

import matplotlib.pyplot as plt
import numpy as np

import visviva as vv

scene = vv.datasets.solar_system().scene
out = scene.run(t=np.linspace(0.0, 12.0 * 365.25, 3000), method="dop853", rtol=1e-12)
with plt.style.context(vv.plot_style()):
    fig, (inner, outer) = plt.subplots(1, 2, figsize=(10, 5.2), layout="constrained")
for ax, names, title in (
    (inner, ["Mercury", "Venus", "Earth", "Mars"], "The inner planets, 2 years"),
    (outer, ["Jupiter", "Saturn", "Uranus", "Neptune"], "The outer planets, 12 years"),
):
    for name in names:
        path = (out[name].position - out["Sun"].position)[: 500 if ax is inner else None]
        (line,) = ax.plot(path[:, 0], path[:, 1], lw=1.0, label=name)
        ax.plot(path[-1, 0], path[-1, 1], "o", ms=5, color=line.get_color())
    ax.plot(0.0, 0.0, "o", color="black", ms=4)
    ax.set(xlabel="x (au)", ylabel="y (au)", aspect="equal", title=title)
    ax.legend(loc="upper left", bbox_to_anchor=(0.0, -0.12), ncols=4, fontsize="small", frameon=False)
