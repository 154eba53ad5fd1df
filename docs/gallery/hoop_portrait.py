"""A bead on a hoop that turns fast has two places to rest: its phase portrait, and the potential it moves in."""

import matplotlib.pyplot as plt
import numpy as np

import visviva as vv

bead = vv.Lagrangian(
    lambda q, v, _, Omega, g: (v[0] ** 2 + Omega**2 * np.sin(q[0]) ** 2) / 2 + g * np.cos(q[0]),
    ["theta"],
    parameters={"Omega": 4.0, "g": 9.81},
    position=[0.3],
)
with plt.style.context(vv.plot_style()):
    fig, (upper, lower) = plt.subplots(2, 1, figsize=(6, 7), sharex=True, height_ratios=(3, 2), layout="constrained")
bead.plot_phase_portrait((-4.0, 4.0), (-6.5, 6.5), ax=upper)
bead.run(t=np.linspace(0.0, bead.period(), 401)).plot_phase(ax=upper)
bead.plot_effective_potential((-4.0, 4.0), ax=lower)
upper.set_title("A bead on a turning hoop, let go at 0.3")
