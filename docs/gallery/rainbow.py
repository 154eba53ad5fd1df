"""The deflection function of a Lennard-Jones potential, and its rainbow."""

import matplotlib.pyplot as plt
import numpy as np

import visviva as vv

atom = vv.potentials.LennardJones(epsilon=1.0, sigma=1.0)
b = np.linspace(0.0, 3.0, 600)
bow = vv.scattering.rainbows(atom, energy=2.0)[0]
fig, ax = plt.subplots(figsize=(6, 4), layout="constrained")
ax.plot(b, vv.scattering.deflection_angle(atom, energy=2.0, impact_parameter=b))
ax.plot(bow.impact_parameter, bow.angle, "o", label="rainbow")
ax.axhline(0.0, color="0.7", lw=0.8)
ax.set(xlabel="impact parameter", ylabel="deflection (rad)", title="Rainbow scattering")
ax.legend()
