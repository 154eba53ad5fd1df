"""Double pendulums let go a millionth of a radian apart."""

import matplotlib.pyplot as plt
import numpy as np

import visviva as vv

start = np.array([2.0, 2.5]) + 1e-6 * np.arange(8)[:, None]
out = vv.systems.double_pendulum().ensemble(position=start).run(t=np.linspace(0.0, 15.0, 1501))
with plt.style.context(vv.plot_style()):
    fig, ax = plt.subplots(figsize=(7, 4), layout="constrained")
ax.plot(out.t, out.position[..., 0].T, lw=0.9)
ax.set(xlabel="t", ylabel="upper angle (rad)", title="Eight double pendulums, 1e-6 rad apart")
