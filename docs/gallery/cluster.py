"""A cold cluster of five hundred stars collapses and rebounds."""

import matplotlib.pyplot as plt
import numpy as np

import visviva as vv

rng = np.random.default_rng(1)
number = 500
place = rng.normal(size=(number, 3))
place *= rng.uniform(0.0, 1.0, number)[:, None] ** (1.0 / 3.0) / np.linalg.norm(place, axis=1)[:, None]
stars = vv.Particles(np.full(number, 1.0 / number), place, 0.1 * rng.normal(size=(number, 3)))
t = np.linspace(0.0, 4.0, 81)
out = vv.Scene(stars, vv.Gravity(G=1.0, softening=0.05)).run(t=t, method="leapfrog", dt=0.01)
distance = np.linalg.norm(out.position - out.center_of_mass[:, None], axis=-1)
with plt.style.context(vv.plot_style()):
    fig, (left, right) = plt.subplots(1, 2, figsize=(10, 4.4), layout="constrained")
for when in (0, 28, 80):
    left.plot(*out.position[when, :, :2].T, ".", ms=2.5, label=f"t = {t[when]:g}")
left.set(xlabel="x", ylabel="y", xlim=(-2.2, 2.2), ylim=(-2.2, 2.2), aspect="equal", title="Three moments")
left.legend(markerscale=3, loc="upper left", bbox_to_anchor=(0.0, -0.15), ncols=3, fontsize="small")
for share in (0.25, 0.5, 0.75):
    right.plot(t, np.quantile(distance, share, axis=1), label=f"{share:.0%} of the mass")
right.set(xlabel="t", ylabel="radius", ylim=(0, 2), title="Radii that hold so much of it")
right.legend(fontsize="small")
