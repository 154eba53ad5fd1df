"""A Poincaré section of Hénon and Heiles' system: islands of order in a sea of chaos."""

import matplotlib.pyplot as plt
import numpy as np

import visviva as vv

energy = 0.125
with plt.style.context(vv.plot_style()):
    fig, ax = plt.subplots(figsize=(6, 5.5), layout="constrained")
for y, p_y in ((0.0, 0.1), (0.0, 0.2), (0.0, 0.3), (0.3, 0.0), (0.45, 0.0), (0.55, 0.0), (-0.2, 0.0), (-0.1, 0.0)):
    p_x = np.sqrt(2.0 * energy - p_y**2 - y**2 + 2.0 * y**3 / 3.0)
    system = vv.systems.henon_heiles(position=[0.0, y], momentum=[p_x, p_y])
    system.poincare("x", t=1500.0).plot("y", ax=ax)
ax.set(title="Hénon–Heiles, E = 1/8, where x passes 0 upwards")
