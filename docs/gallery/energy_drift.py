"""The energy of a symplectic method stays; that of a Runge–Kutta method leaks."""

import matplotlib.pyplot as plt
import numpy as np

import visviva as vv

scene = vv.problems.kepler(e=0.3).scene
t = np.linspace(0.0, 200.0 * 2.0 * np.pi, 4001)
with plt.style.context(vv.plot_style()):
    fig, ax = plt.subplots(figsize=(7.5, 4), layout="constrained")
for method in ("rk4", "leapfrog", "yoshida4", "kahan_li8"):
    energy = scene.run(t=t, method=method, dt=2.0 * np.pi / 100.0, record="energy").energy
    error = np.abs(energy / energy[0] - 1.0)
    turns = t[1:].reshape(-1, 20)[:, -1] / (2.0 * np.pi)
    ax.plot(turns, error[1:].reshape(-1, 20).max(axis=1), label=method)  # the largest of each turn
ax.set(
    xlabel="turns", ylabel="|E/E₀ − 1|, largest of each turn", yscale="log", title="Kepler's problem, 100 steps a turn"
)
fig.legend(loc="outside right upper")
