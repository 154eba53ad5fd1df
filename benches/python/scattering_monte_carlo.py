"""The scattering Monte Carlo of any potential against a numba parallel loop of the bare Rutherford angle, in one run.

The peer draws b² uniform over a disc, takes Rutherford's angle and counts it in 180 bins: the least that a Monte Carlo
of any kind can do. Ours scatters off a screened potential: one tally at one energy, then a spectrum of energies with
laboratory kinematics and a histogram of two quantities together. Then the tables: bytes, certified error, seconds; and
χ² of 10⁹ Rutherford events.

    python benches/python/scattering_monte_carlo.py [events] [threads]
"""

from __future__ import annotations

import sys

import numba
import numpy as np
from _harness import Row, at_most, faster, minima, report
from rutherford import peer

import visviva as vv
from visviva import _core
from visviva.scattering._beam import described

p = vv.potentials
BEAM = {"masses": (4.0, 27.0), "b_max": 5.0, "seed": 1}
LINES = vv.scattering.Spectrum(np.linspace(0.8, 1.2, 41), np.exp(-0.5 * np.linspace(-3.0, 3.0, 41) ** 2))
TARGETS = {
    "ZBL": p.ScreenedCoulomb(1.0, 1.0, "zbl"),
    "Yukawa": p.Yukawa(1.0, 1.0),
    "Lennard-Jones, with a rainbow": p.LennardJones(0.2, 1.0),
    "Lennard-Jones, orbiting": p.LennardJones(2.0, 1.0),
    "hard sphere": p.HardSphere(1.0),
}
KINDS: dict[str, tuple[float, dict[str, object]]] = {
    "one tally, one energy": (8.0, {"beam_energy": 1.0, "tally": "cm_angle"}),
    "41 energies, LAB, 2-D tally 90 × 90": (
        2.5,
        {"beam_energy": LINES, "tally": [("lab_angle", "energy")], "bins": 90},
    ),
}


def throughput(n: int, threads: int) -> list[Row]:
    numba.set_num_threads(threads)
    peer(1000, 16 * threads, 0.5, 5.0, 180)
    rows = []
    for what, (bar, asked) in KINDS.items():
        for name, potential in TARGETS.items():

            def ours(potential: vv.potentials.Potential = potential, asked: dict[str, object] = asked) -> object:
                return vv.scattering.monte_carlo(potential, n_events=n, threads=threads, **{**BEAM, **asked})

            slow, fast = minima(lambda: peer(n, 16 * threads, 0.5, 5.0, 180), ours, repeats=3)
            rates = [f"{n / seconds / 1e6:.0f} M/s" for seconds in (fast, slow)]
            rows.append(faster(f"{what}: {name}, {threads} threads", *rates, slow / fast, bar))
    return rows


def tables() -> list[Row]:
    rows = []
    for name, potential in TARGETS.items():
        one, several = (
            described(vv.scattering.Beam(potential, energy, BEAM["masses"], BEAM["b_max"], 0.0))
            for energy in (1.0, LINES)
        )

        def build(beam: dict[str, object] = one) -> list[tuple[int, int, float, float]]:
            keywords = {"n_events": 1, "seed": 1, "first_event": 0, "threads": 2, "progress": None}
            return _core.monte_carlo(beam=beam, tallies=[[("cm_angle", 1)]], **keywords)[3]

        built = build()
        rows.append(at_most(f"{name}: bytes of one energy", built[0][1], 65536))
        rows.append(at_most(f"{name}: certified error of sin²(ψ/2)", built[0][2], 4e-6))
        rows.append(at_most(f"{name}: ms to build", 1e3 * minima(build, repeats=5)[0], 50.0))
        rows.append(at_most(f"{name}: bytes of 41 energies", sum(table[1] for table in build(several)), 5e5))
        rows.append(at_most(f"{name}: s to build", minima(lambda: build(several), repeats=2)[0], 1.0))  # noqa: B023
    return rows


def chi_square(n: int, threads: int) -> list[Row]:
    from scipy.stats import chi2

    rows = []
    for seed in (1, 2, 3):
        angles = np.sort(
            vv.scattering.rutherford_angle(
                p.Coulomb(1.0), energy=1.0 * 27.0 / 31.0, impact_parameter=5.0 * np.sqrt(np.linspace(0.0, 1.0, 181))
            )
        )
        # The outermost edges lose nothing to rounding.
        angles[0], angles[-1] = angles[0] * (1.0 - 1e-12), np.pi
        result = vv.scattering.monte_carlo(
            p.Coulomb(1.0),
            beam_energy=1.0,
            n_events=n,
            threads=threads,
            tally={"cm_angle": angles},
            **{**BEAM, "seed": seed},
        )
        counts = result["cm_angle"].values()
        value = float(chi2.sf(((counts - n / 180) ** 2 / (n / 180)).sum(), 179))
        rows.append(
            Row(
                f"seed {seed}: p of χ², {n:.0e} events",
                f"{value:.3f}",
                "",
                "",
                "1e-3 to 1 − 1e-3",
                1e-3 < value < 0.999,
            )
        )
    return rows


def main() -> None:
    n = int(float(sys.argv[1])) if len(sys.argv) > 1 else 1_000_000_000
    threads = int(sys.argv[2]) if len(sys.argv) > 2 else 2
    report("Scattering Monte Carlo", throughput(n // 5, threads), "Peer: numba's loop of the bare Rutherford angle.")
    report("Event tables", tables(), "Built with two threads.")
    report("χ²", chi_square(n, threads), "180 bins of equal probability.")


if __name__ == "__main__":
    main()
