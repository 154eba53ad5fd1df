"""What ``visviva demo`` shows: two runs on real input, each with a table and a picture."""

from __future__ import annotations

from importlib.util import find_spec
from typing import TYPE_CHECKING

import numpy as np

import visviva as vv
from visviva._residuals import new_panels

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

__all__ = ["outer_solar_system", "rutherford"]

# Radium C alpha particles on gold, in MeV and fm: e²/4πε₀ = 1.43996454844 MeV fm; masses in u.
_ALPHA_ENERGY = 7.687
_ALPHA_MASS, _GOLD_MASS = 4.001506179, 196.923232301
_K = 2 * 79 * 1.43996454844
# Deflections below this are left out by the radius of the disc, as Geiger and Marsden left them out.
_SMALLEST_ANGLE = np.radians(12.0)


def outer_solar_system(output: Path, days: float, threads: int | None) -> list[Path]:
    """Follow the Sun and five outer planets; print where they are and how well the invariants held."""
    problem = vv.problems.outer_solar_system()
    data = vv.datasets.outer_solar_system()
    step = 50.0
    print(f"The outer Solar System for {days:g} days ({data.source})")
    out = problem.scene.center_of_mass_frame().run(
        t=np.linspace(0.0, days, 2001), method="kahan_li8", dt=step, threads=threads, progress=_progress()
    )
    print(f"\n{'':<9}{'x':>20}{'y':>20}{'z':>20}   [AU, from the center of mass]")
    for name, row in zip(out.scene.particles.names, out.position[-1], strict=True):
        print(f"{name:<9}" + "".join(f"{value:>20.12f}" for value in row))
    print(f"\n{out.conservation()}\n")
    check = problem.scene.run(t=problem.t_end, method="kahan_li8", dt=step, threads=threads)
    print(f"distance from a quadruple-precision reference at {problem.t_end:g} days: {problem.error(check):.1e} AU")
    stats = out.stats
    print(
        f"{stats.steps} steps of {step:g} days with {stats.method} in {stats.seconds:.3f} s: "
        f"{stats.steps / stats.seconds:.3g} steps/s, {days / 365.25 / stats.seconds:.3g} years/s "
        f"({stats.simd}, {stats.threads} thread{'s' if stats.threads != 1 else ''})"
    )
    out.save(output / "outer_solar_system.npz")
    if find_spec("matplotlib") is None:
        return []
    path = output / "outer_solar_system.png"
    out.plot().savefig(path, dpi=150)
    return [path]


def rutherford(output: Path, events: int, threads: int | None) -> list[Path]:
    """Scatter alpha particles off gold; compare with Rutherford's law and with the counts of 1913."""
    measured = vv.datasets.geiger_marsden_1913()
    angles = np.radians(measured.angle)
    # b = (k / 2E) cot(ψ/2) with the energy E of relative motion.
    energy = _ALPHA_ENERGY * _GOLD_MASS / (_ALPHA_MASS + _GOLD_MASS)
    half_distance = _K / (2.0 * energy)
    b_max = half_distance / np.tan(_SMALLEST_ANGLE / 2.0)
    print(f"Rutherford scattering: {events:.3g} alpha particles of {_ALPHA_ENERGY} MeV on gold nuclei")
    half_width = np.radians(1.0)
    slots = np.ravel([[angle - half_width, angle + half_width] for angle in np.sort(angles)])
    result = vv.scattering.monte_carlo(
        vv.potentials.Coulomb(_K),
        beam_energy=_ALPHA_ENERGY,
        masses=(_ALPHA_MASS, _GOLD_MASS),
        b_max=float(b_max),
        n_events=events,
        seed=1913,
        tally={"cm_angle": np.linspace(_SMALLEST_ANGLE, np.pi, 57), "lab_angle": slots},
        threads=threads,
        progress=_progress(),
    )
    _compare_with_law(result["cm_angle"], half_distance / b_max, events)
    simulated = result["lab_angle"].values()[::2] / -np.diff(np.cos(slots))[::2]
    order = np.argsort(np.argsort(angles))
    _compare_with_1913(measured, simulated[order])
    if find_spec("matplotlib") is None:
        return []
    return [_picture(output / "rutherford.png", measured, np.sort(angles), simulated)]


def _expected(edges: NDArray[np.float64], ratio: float, events: int) -> NDArray[np.float64]:
    """Rutherford's law in each bin: P(ψ > ψ₀) = (b(ψ₀) / b_max)² = (ratio · cot(ψ₀/2))²."""
    beyond = (ratio / np.tan(edges / 2.0)) ** 2
    return np.asarray(-np.diff(beyond) * events)


def _compare_with_law(tally: vv.scattering.Tally, ratio: float, events: int) -> None:
    expected = _expected(tally.edges, ratio, events)
    pulls = (tally.values() - expected) / np.sqrt(expected)
    print(f"\n{'angle in the center-of-mass frame':<36}{'counted':>14}{'law':>16}{'(counted - law)/σ':>20}")
    for index in range(0, len(expected), 8):
        low, high = np.degrees(tally.edges[index : index + 2])
        span = f"{low:6.1f}° … {high:6.1f}°"
        counted = int(tally.values()[index])
        print(f"{span:<36}{counted:>14}{expected[index]:>16.1f}{pulls[index]:>20.2f}")
    print(f"all {len(pulls)} bins: χ² = {pulls @ pulls:.1f}")


def _compare_with_1913(measured: vv.datasets.GeigerMarsden, simulated: NDArray[np.float64]) -> None:
    if not simulated.all():
        print("\ntoo few events for a comparison with 1913: no particle reached some of the angles")
        return
    print(f"\n{'angle':>7}{'gold, 1913':>14}{'simulated':>14}{'ratio':>8}    (one common scale)")
    scale = np.exp(np.mean(np.log(measured.gold / simulated)))
    for angle, count, value in zip(measured.angle, measured.gold, simulated * scale, strict=True):
        print(f"{angle:>6.1f}°{count:>14.1f}{value:>14.1f}{count / value:>8.2f}")


def _picture(
    path: Path, measured: vv.datasets.GeigerMarsden, angles: NDArray[np.float64], simulated: NDArray[np.float64]
) -> Path:
    figure, _ = new_panels([True], (6.5, 6.0))
    axes, ratios = figure.axes
    silver, gold = measured.compare()
    if simulated.all():
        scaled = simulated * np.exp(np.mean(np.log(measured.gold[np.argsort(measured.angle)] / simulated)))
        axes.plot(np.degrees(angles), scaled, "+", markersize=9, color="black", label="gold: simulated")
        ratios.plot(
            np.degrees(angles), scaled * np.sin(angles / 2.0) ** 4 / gold.scale, "+", markersize=9, color="black"
        )
    for metal in (silver, gold):
        metal.plot(ax=axes, residuals=ratios)
    figure.savefig(path, dpi=150)
    return path


def _progress() -> bool:
    """A bar if there is something to draw it with."""
    return find_spec("tqdm") is not None


def __dir__() -> list[str]:
    return list(__all__)
