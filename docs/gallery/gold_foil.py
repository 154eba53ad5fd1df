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
energy = 50.0 / 51.0  # of relative motion
law = vv.scattering.cross_section(nucleus, energy=energy, angle=middle[seen])
degrees, value, error = np.degrees(middle[seen]), sigma.value[seen], sigma.error[seen]
with plt.style.context(vv.plot_style()):
    fig, (ax, left) = plt.subplots(2, 1, figsize=(6, 5.5), height_ratios=(3, 1), sharex=True, layout="constrained")
ax.errorbar(degrees, value, error, fmt="o", ms=3, label="Monte Carlo, 100 000 events")
ax.plot(degrees, law, label="Rutherford", zorder=3)
ax.set(xlabel="angle (degrees)", ylabel="dσ/dΩ", yscale="log", title="Gold foil")
ax.legend()
left.axhspan(-1.0, 1.0, color="0.93")
counted, expected = run.counts[seen], run.expected()[seen]  # over each bin, where the law bends
left.plot(degrees, (counted - expected) / np.sqrt(expected), "o", ms=3)
left.set(xlabel="angle (degrees)", ylabel="in σ", title="What is left over")
