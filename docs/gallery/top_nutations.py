"""A heavy top nods in loops, cusps or waves, as it is let go."""

import matplotlib.pyplot as plt
import numpy as np

import visviva as vv

top = vv.rigid.HeavyTop(A=1.0, C=0.5, mass=1.0, g=1.0, R=1.0)
with plt.style.context(vv.plot_style()):
    fig, ax = plt.subplots(figsize=(7, 4), layout="constrained")
for phi_dot in (-0.3, 0.0, 0.3):
    kind = top.nutation(0.7, phi_dot=phi_dot, psi_dot=8.0).kind
    out = top.solve(np.linspace(0.0, 8.0, 2001), theta=0.7, phi_dot=phi_dot, psi_dot=8.0)
    ax.plot(np.degrees(out.phi), np.degrees(out.theta), label=kind)
ax.invert_yaxis()
ax.set(xlabel="φ (degrees)", ylabel="θ (degrees)", title="Nutations of a heavy top")
fig.legend(loc="outside right upper")
