"""A charge in crossed fields circles and drifts across both."""

import matplotlib.pyplot as plt
import numpy as np

import visviva as vv

charge = vv.Particles([1.0], [[0, 0, 0]], [[0.0, 1.0, 0.0]])
fields = vv.UniformElectricField([0.2, 0, 0]), vv.UniformMagneticField([0, 0, 1.0])
out = vv.Scene(charge, *fields).run(t=np.linspace(0.0, 40.0, 2001))
with plt.style.context(vv.plot_style()):
    fig, ax = plt.subplots(figsize=(4, 6), layout="constrained")
ax.plot(*out.position[:, 0, :2].T)
ax.set(xlabel="x", ylabel="y", aspect="equal", title="E × B drift")
