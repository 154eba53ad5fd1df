"""The plane of Foucault's pendulum turns with the sine of the latitude."""

import matplotlib.pyplot as plt
import numpy as np

import visviva as vv

pendulum = vv.systems.foucault(Omega=7.292115e-5 * 60.0)  # sixty times too fast, for the eye
swing = 2.0 * np.pi * np.sqrt(67.0 / 9.81)
x, y = pendulum.run(t=np.linspace(0.0, 20.0 * swing, 6001)).position.T
with plt.style.context(vv.plot_style()):
    fig, ax = plt.subplots(figsize=(5, 5.2), layout="constrained")
ax.plot(x, y, lw=0.8)
ax.plot(x[0], y[0], "o", label="let go here")
ax.set(xlabel="east (m)", ylabel="north (m)", aspect="equal", title="Foucault's pendulum in Paris, Earth 60 × as fast")
ax.legend(loc="upper right")
