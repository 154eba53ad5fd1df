"""Rutherford Monte Carlo with a histogram of 180 bins: visviva against a numba parallel loop, in one run.

The same job on both sides: b² uniform over a disc, the scattering angle counted in 180 equal bins of [0, π]. Prints
events per second, the ratio, and whether both histograms agree within their statistics. Numba's loop draws from its
per-thread xoshiro generator, the fastest it has; its counts depend on the number of threads, visviva's do not.

    python benches/python/rutherford.py [events] [threads]
"""

from __future__ import annotations

import sys
import time
from typing import TYPE_CHECKING

import numba
import numpy as np

import visviva as vv

if TYPE_CHECKING:
    from collections.abc import Callable

BINS = 180
KAPPA, B_MAX = 0.5, 5.0


@numba.njit(parallel=True, fastmath=True)
def peer(n: int, chunks: int, kappa: float, b_max: float, bins: int) -> np.ndarray:
    partial = np.zeros((chunks, bins), np.int64)
    scale = bins / np.pi
    for chunk in numba.prange(chunks):
        counts = np.zeros(bins, np.int64)
        for _ in range(n // chunks):
            b = b_max * np.sqrt(np.random.random())
            angle = 2.0 * np.arctan2(kappa, b)
            counts[min(int(angle * scale), bins - 1)] += 1
        partial[chunk] = counts
    return partial.sum(axis=0)


def best(function: Callable[[], object], repeats: int = 5) -> float:
    times = []
    for _ in range(repeats):
        start = time.perf_counter()
        function()
        times.append(time.perf_counter() - start)
    return min(times)


def main() -> None:
    n = int(float(sys.argv[1])) if len(sys.argv) > 1 else 100_000_000
    most = int(sys.argv[2]) if len(sys.argv) > 2 else 2
    potential = vv.potentials.Coulomb(1.0)

    def ours(threads: int) -> np.ndarray:
        result = vv.scattering.monte_carlo(
            potential, beam_energy=1.0, masses=(1.0, 1e300), b_max=B_MAX, n_events=n, seed=1, bins=BINS, threads=threads
        )
        return result["cm_angle"].values()

    print(f"{n:.0e} events, {BINS} bins, SIMD tier {vv._core.info()['simd']}; best of 5")
    print(f"{'threads':>8}{'numba, M/s':>14}{'visviva, M/s':>14}{'ratio':>8}")
    for threads in range(1, most + 1):
        numba.set_num_threads(threads)
        counts = peer(n, 16 * threads, KAPPA, B_MAX, BINS)
        slow = best(lambda: peer(n, 16 * threads, KAPPA, B_MAX, BINS))  # noqa: B023
        fast = best(lambda: ours(threads))  # noqa: B023
        print(f"{threads:>8}{n / slow / 1e6:>14.1f}{n / fast / 1e6:>14.1f}{slow / fast:>8.1f}")
        own = ours(threads)
        filled = own + counts > 20
        chi2 = ((own - counts)[filled] ** 2 / (own + counts)[filled]).sum()
        print(f"{'':>8}both histograms: χ² = {chi2:.0f} of {filled.sum()} bins")


if __name__ == "__main__":
    main()
