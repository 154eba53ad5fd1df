"""Rutherford's formula and counts of a Monte Carlo."""

import matplotlib.pyplot as plt
import numpy as np

import visviva as vv

nucleus = vv.potentials.Coulomb(k=1.0)
run = vv.scattering.monte_carlo(
    nucleus, beam_energy=1.0, masses=(1.0, 50.0), b_max=5.0, n_events=100_000, seed=1, bins=40
)["cm_angle"]
middle = (run.edges[1:] + run.edges[:-1]) / 2
seen = run.counts > 3  # of fewer nothing can be drawn but noise
seen[np.flatnonzero(seen)[0]] = False  # cut off by b_max: not all of this bin can be reached
sigma = run.cross_section()
fig, ax = plt.subplots(figsize=(6, 4), layout="constrained")
ax.errorbar(
    np.degrees(middle[seen]), sigma.value[seen], sigma.error[seen], fmt="o", ms=3, label="Monte Carlo, 100 000 events"
)
energy = 50.0 / 51.0  # of relative motion
line = vv.scattering.cross_section(nucleus, energy=energy, angle=middle[seen])
ax.plot(np.degrees(middle[seen]), line, label="Rutherford", zorder=3)
ax.set(xlabel="angle (degrees)", ylabel="dσ/dΩ", yscale="log", title="Gold foil")
ax.legend()
