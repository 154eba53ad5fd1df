"""Einstein's part of the turn of Mercury's perihelion: 43 seconds of arc in a century."""

import matplotlib.pyplot as plt
import numpy as np

import visviva as vv

data = vv.datasets.solar_system()
sun_and_mercury = data.scene.particles[["Sun", "Mercury"]]
gravity = next(force for force in data.scene.forces if isinstance(force, vv.Gravity))
light = 173.14463267  # au per day
scene = vv.Scene(sun_and_mercury, gravity, vv.PostNewtonian("Sun", G=gravity.G, c=light))
t = np.linspace(0.0, 36525.0, 401)
out = scene.run(t=t, method="dop853", rtol=1e-13)
turned = np.unwrap(out.elements("Mercury", about="Sun").longitude_of_pericenter)
seconds = np.degrees(turned - turned[0]) * 3600.0
with plt.style.context(vv.plot_style()):
    fig, ax = plt.subplots(figsize=(6, 4), layout="constrained")
ax.plot(t / 365.25, seconds, lw=0.8, label="osculating perihelion")
ax.plot(t / 365.25, 42.98 * t / 36525.0, "--", label="42.98″ a century")
ax.set(xlabel="years", ylabel="turned by (arc seconds)", title="Mercury's perihelion, Sun and Mercury alone")
ax.legend()
