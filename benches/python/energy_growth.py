"""How the energy error of Kahan–Li 8 grows on the round-off floor: an exponent near 1/2 is a random walk.

One walk proves nothing: rms over perturbed copies of Applegate's outer Solar System, at times from
3.65e5 to 3.65e7 days (two decades), with 25-day steps, and a fit of log rms against log time. The copies' common
part (their mean) and their scatter are fitted apart as well: a bias common to all copies is no random walk.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from _harness import Row, report

import visviva as vv

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

COPIES, STEP, START, END, TIMES = 32, 25.0, 3.65e5, 3.65e7, 25


def exponent(times: NDArray[np.float64], values: NDArray[np.float64]) -> float:
    return float(np.polyfit(np.log(times), np.log(values), 1)[0])


def rows() -> Iterator[Row]:
    scene = vv.problems.outer_solar_system("applegate").scene
    random = np.random.default_rng(1905)
    position = scene.particles.position * (1.0 + 1e-9 * random.normal(size=(COPIES, 6, 3)))
    # On nodes, so that no partial step adds its own rounding.
    times = np.round(np.geomspace(START, END, TIMES) / STEP) * STEP
    out = scene.ensemble(position=position).run(
        t=np.append(0.0, times), method="kahan_li8", dt=STEP, record=("energy",)
    )
    error = out.energy[:, 1:] / out.energy[:, :1] - 1.0
    rms, mean, scatter = np.sqrt((error**2).mean(axis=0)), error.mean(axis=0), error.std(axis=0)
    slope = exponent(times, rms)
    yield Row(
        f"rms over {COPIES} copies, {START:g} to {END:g} d, {STEP:g} d steps",
        f"exponent {slope:.3f} ({rms[0]:.1e} to {rms[-1]:.1e})",
        "",
        "",
        "0.5 ± 0.1",
        abs(slope - 0.5) <= 0.1,
    )
    worst = int(np.abs(mean / scatter).argmax())
    yield Row(
        "scatter about the mean of the copies",
        f"exponent {exponent(times, scatter):.3f} ({scatter[0]:.1e} to {scatter[-1]:.1e}); "
        f"largest mean over scatter {mean[worst] / scatter[worst]:.2f} at {times[worst]:.1e} d",
        "",
        "",
        "",
        None,
    )


if __name__ == "__main__":
    report("Growth of the energy error", rows(), "Kahan–Li 8, energy recorded by the core with compensated sums.")
