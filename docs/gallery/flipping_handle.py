"""A handle spun about its middle axis flips over, again and again."""

import matplotlib.pyplot as plt
import numpy as np

import visviva as vv

handle = vv.rigid.free_rotation([1.0, 2.0, 3.0], [1e-3, 1.0, 1e-3], np.linspace(0.0, 100.0, 2001))
with plt.style.context(vv.plot_style()):
    fig, ax = plt.subplots(figsize=(6, 4), layout="constrained")
for axis, name in enumerate(("small", "middle", "large")):
    ax.plot(handle.t, handle.angular_velocity[:, axis], label=f"about the {name} axis")
ax.set(xlabel="t", ylabel="angular velocity", title="The flipping handle")
fig.legend(loc="outside lower center", ncols=3, fontsize="small")
