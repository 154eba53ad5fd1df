"""Deflection functions of a Lennard-Jones potential, with rainbows, glories and an orbit."""

import matplotlib.pyplot as plt
import numpy as np

import visviva as vv

atom = vv.potentials.LennardJones(epsilon=1.0, sigma=1.0)
b = np.linspace(0.0, 3.0, 901)
with plt.style.context(vv.plot_style()):
    fig, ax = plt.subplots(figsize=(7, 4), layout="constrained")
vv.scattering.deflect(atom, energy=[[0.5], [1.0], [4.0]], impact_parameter=b).plot(ax=ax)
ax.set_title("Rainbow scattering")
