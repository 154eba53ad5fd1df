"""A pendulum whose pivot shakes stands upside down, if it shakes fast enough."""

import matplotlib.pyplot as plt
import numpy as np

import visviva as vv

t = np.linspace(0.0, 6.0, 3001)
with plt.style.context(vv.plot_style()):
    fig, ax = plt.subplots(figsize=(7, 4), layout="constrained")
for rate in (100.0, 60.0, 40.0):
    angle = vv.systems.kapitza(Omega=rate, position=[2.9]).run(t=t)["theta"]
    stands = (0.1 * rate) ** 2 > 2.0 * 9.81
    ax.plot(t, np.degrees(angle), lw=1.0, label=f"Ω = {rate:g}/s: {'stands' if stands else 'falls'}")
ax.axhline(180.0, color="0.6", lw=0.8, ls="--")
ax.set(xlabel="t (s)", ylabel="angle from below (degrees)", title="Kapitza's pendulum, pivot shaken by 10 cm")
ax.legend(frameon=False)
