"""How the energy error of `gauss16` on Hénon–Heiles grows at round-off: an exponent near 1/2 is a random walk.

32 copies near (0.1, 0; 0, 0.5), to t = 5e4 with equal steps of 0.5: a fit of log rms against log time over two decades,
the scatter about the mean of the copies, and the drift of that mean per unit of time with its standard error. A drift
that is many standard errors from zero is a bias of the method; one within them is what 32 random walks leave.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from _harness import Row, report
from energy_growth import exponent

import visviva as vv

if TYPE_CHECKING:
    from collections.abc import Iterator

COPIES, STEP, START, END, TIMES = 32, 0.5, 5e2, 5e4, 25


def rows() -> Iterator[Row]:
    random = np.random.default_rng(1964)
    system = vv.systems.henon_heiles()
    many = system.ensemble(
        position=np.array([0.1, 0.0]) + 1e-3 * random.normal(size=(COPIES, 2)),
        momentum=np.array([0.0, 0.5]) + 1e-3 * random.normal(size=(COPIES, 2)),
    )
    # On nodes, so that no shadow step adds its own rounding.
    times = np.round(np.geomspace(START, END, TIMES) / STEP) * STEP
    out = many.run(np.append(0.0, times), method="gauss16", dt=STEP)
    error = out.energy[:, 1:] / out.energy[:, :1] - 1.0
    rms, scatter = np.sqrt((error**2).mean(axis=0)), error.std(axis=0)
    slope = exponent(times, rms)
    yield Row(
        f"rms over {COPIES} copies, t = {START:g} to {END:g}, steps of {STEP:g}",
        f"exponent {slope:.3f} ({rms[0]:.1e} to {rms[-1]:.1e}, largest {np.abs(error).max():.1e})",
        "",
        "",
        "0.5 ± 0.1, ≤ 1e-13",
        abs(slope - 0.5) <= 0.1 and float(rms[-1]) <= 1e-13,
    )
    drift, doubt = error[:, -1].mean() / times[-1], error[:, -1].std(ddof=1) / np.sqrt(COPIES) / times[-1]
    yield Row(
        "scatter about the mean of the copies, and the drift of that mean",
        f"exponent {exponent(times, scatter):.3f}; {drift:.1e} ± {doubt:.1e} per unit of time",
        "",
        "",
        "",
        None,
    )


if __name__ == "__main__":
    report("Growth of the energy error of Hénon–Heiles", rows(), "Energies are those of states at nodes, in doubles.")
