"""Two coupled pendulums hand their swing to each other and back."""

import matplotlib.pyplot as plt
import numpy as np

import visviva as vv

system = vv.systems.coupled_oscillators(position=[1.0, 0.0])
out = system.run(t=np.linspace(0.0, 80.0, 4001))
with plt.style.context(vv.plot_style()):
    fig, panels = plt.subplots(2, 1, figsize=(7, 5), layout="constrained")
for ax, name in zip(panels, system.coordinates, strict=True):
    ax.plot(out.t, out[name], lw=0.9)
    ax.set(xlabel="t", ylabel=name, title=f"Oscillator {name}")
