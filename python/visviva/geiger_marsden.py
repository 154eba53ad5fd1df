"""What ``visviva geiger-marsden`` shows: alpha particles through silver and gold, against the counts of 1913.

The counts were normalized by their authors and are no raw counts, so their errors are taken as 5 % of each; one scale
is fitted to each metal, from 45° to 150°. Below, the thickness of the foils and the width of the beam count.
"""

from __future__ import annotations

from dataclasses import dataclass
from importlib.util import find_spec
from typing import TYPE_CHECKING, Literal

import numpy as np

import visviva as vv
from visviva._residuals import new_panels
from visviva.datasets._pictures import COUNT_ERROR, plot_counts

if TYPE_CHECKING:
    from pathlib import Path

    from matplotlib.axes import Axes
    from numpy.typing import NDArray

__all__ = ["MetalComparison", "compare_metal", "geiger_marsden"]

# Radium C.
_ENERGY = 7.687e6
# Relative error of a published number, and the angles in degrees that are fitted.
_ERROR, _FITTED = COUNT_ERROR, (45.0, 150.0)
# Half of an angular slot in degrees at the widest, and the least angle that is forced.
_HALF_WIDTH, _FORCED = 4.0, 10.0
# In what follows angles below this one are as good as none: large angles are what is looked at.
_MINIMUM_ANGLE = 2e-3
_E2 = 14.399645478  # e²/4πε₀ in eV Å


@dataclass(frozen=True, eq=False)
class MetalComparison:
    """One metal: what was counted, what the simulation and Rutherford's law say.

    Attributes
    ----------
    metal : str
        ``"silver"`` or ``"gold"``.
    angle : ndarray
        Degrees, increasing.
    counted : ndarray
        As published.
    simulated, simulated_error : ndarray
        Part of the alpha particles per steradian.
    law : ndarray
        The same by Rutherford's law, single collisions with nuclei that recoil.
    scale : float
        What a part per steradian is in counts: fitted to the simulation.
    reduced_chi2 : float
        Of the counts against the scaled simulation.
    reduced_chi2_law : float
        Of the counts against the law, with a scale of its own.
    foil : Foil
        What the alpha particles went through.
    """

    metal: Literal["silver", "gold"]
    angle: NDArray[np.float64]
    counted: NDArray[np.float64]
    simulated: NDArray[np.float64]
    simulated_error: NDArray[np.float64]
    law: NDArray[np.float64]
    scale: float
    reduced_chi2: float
    reduced_chi2_law: float
    foil: vv.scattering.Foil

    def plot(self, *, ax: Axes | None = None, residuals: Axes | None = None) -> Axes:
        """Draw counts, simulation and law, and below the first two over the law; see `RutherfordComparison.plot`."""

        def law(degrees: NDArray[np.float64]) -> NDArray[np.float64]:
            return _law(self.foil, np.radians(degrees)) * self.scale

        return plot_counts(
            ax,
            residuals,
            self.metal,
            self.angle,
            self.counted,
            law,
            simulated=(self.simulated * self.scale, self.simulated_error * self.scale),
            note=f", χ²/f = {self.reduced_chi2:.2f}",
        )


def compare_metal(
    metal: Literal["silver", "gold"],
    *,
    thickness: float = 0.2,
    events: int = 400_000,
    seed: int = 1913,
    threads: int | None = None,
) -> MetalComparison:
    """Send alpha particles of 7.687 MeV through a foil and compare with table II of 1913."""
    data = vv.datasets.geiger_marsden_1913()
    order = np.argsort(data.angle)
    angle, counted = data.angle[order], getattr(data, metal)[order]
    # Slots do not overlap, and are narrow where counts fall steeply.
    half = np.minimum(_HALF_WIDTH, angle / 12.0)
    edges = np.radians(np.ravel([angle - half, angle + half], order="F"))
    foil = vv.scattering.Foil(metal, thickness, minimum_angle=_MINIMUM_ANGLE)
    result = foil.run(
        "alpha",
        beam_energy=_ENERGY,
        n_events=events,
        seed=seed,
        forced_angle=np.radians(_FORCED),
        tally={"lab_angle": edges},
        threads=threads,
        progress=find_spec("tqdm") is not None,
    )
    value, error = (column[::2] for column in result["lab_angle"].fraction())
    # The law at the middle over that in the slot: what the simulation counts in a slot, it says of the middle.
    law, in_slot = _law(foil, np.radians(angle)), _law_between(foil, edges)[::2]
    simulated, simulated_error = value / in_slot * law, error / in_slot * law
    scale, reduced = _fit(angle, counted, simulated, simulated_error)
    _, reduced_law = _fit(angle, counted, law, np.zeros_like(law))
    return MetalComparison(metal, angle, counted, simulated, simulated_error, law, scale, reduced, reduced_law, foil)


def _law(foil: vv.scattering.Foil, angle: NDArray[np.float64]) -> NDArray[np.float64]:
    """Part of the alpha particles per steradian: n t dσ/dΩ."""
    material, alpha = foil.material, 4.001506179127
    ratio = alpha / material.mass[0]
    sigma = vv.scattering.rutherford_cross_section(
        vv.potentials.Coulomb(2.0 * material.atomic_number[0] * _E2),
        energy=_ENERGY / (1.0 + ratio),
        angle=angle,
        frame="lab",
        mass_ratio=ratio,
    )
    return np.asarray(sigma * material.number_density * foil.thickness * 1e4)


def _law_between(foil: vv.scattering.Foil, edges: NDArray[np.float64]) -> NDArray[np.float64]:
    """The law over slots, by Simpson's rule in 64 parts."""
    parts = np.linspace(edges[:-1], edges[1:], 65)
    weights = np.ones(65)
    weights[1:-1:2], weights[2:-1:2] = 4.0, 2.0
    rings = _law(foil, parts) * 2.0 * np.pi * np.sin(parts)
    return np.asarray(weights @ rings * np.diff(edges) / (64 * 3))


def _fit(
    angle: NDArray[np.float64], counted: NDArray[np.float64], said: NDArray[np.float64], error: NDArray[np.float64]
) -> tuple[float, float]:
    """The scale of what is said, and what is left, over the degrees of freedom."""
    fitted = (angle >= _FITTED[0]) & (angle <= _FITTED[1]) & (said > 0.0)
    if fitted.sum() < 3:
        raise vv.InvalidInput(
            "events",
            "expected enough alpha particles that three angles are reached at least; in a foil that is thicker than "
            "their range, about 20 µm, none are",
        )
    relative = np.hypot(_ERROR, error[fitted] / said[fitted])
    ratio = counted[fitted] / said[fitted]
    # Errors are parts of what is said: the scale that leaves least is Σ r²/e² over Σ r/e², r = counted over said.
    scale = float(np.sum((ratio / relative) ** 2) / np.sum(ratio / relative**2))
    left = (ratio / scale - 1.0) / relative
    return scale, float(left @ left) / (int(fitted.sum()) - 1)


def geiger_marsden(output: Path, events: int, thickness: float, threads: int | None) -> list[Path]:
    """Run both metals; print tables and draw the picture."""
    source = vv.datasets.geiger_marsden_1913().source
    print(f"Alpha particles of {_ENERGY / 1e6} MeV through {thickness:g} µm of metal, {events:.3g} for each ({source})")
    metals = [compare_metal(metal, thickness=thickness, events=events, threads=threads) for metal in ("silver", "gold")]
    for found in metals:
        _print(found)
    if find_spec("matplotlib") is None:
        return []
    return [_picture(output / "geiger_marsden.png", metals)]


def _print(found: MetalComparison) -> None:
    print(f"\n{found.metal:<10}{'1913':>10}{'simulated':>14}{'±':>7}{'1913/simulated':>16}{'simulated/law':>15}")
    for angle, counted, said, error, law in zip(
        found.angle, found.counted, found.simulated, found.simulated_error, found.law, strict=True
    ):
        if said == 0.0:
            print(f"{angle:>6.1f}°   {counted:>10.1f}{'none':>14}")
            continue
        mark = "" if angle >= _FITTED[0] else "   not fitted"
        print(
            f"{angle:>6.1f}°   {counted:>10.1f}{said * found.scale:>14.1f}{error / said:>7.1%}"
            f"{counted / said / found.scale:>16.3f}{said / law:>15.3f}{mark}"
        )
    print(
        f"χ² per degree of freedom, 45° to 150°, errors of 5 %: {found.reduced_chi2:.2f} (simulation), "
        f"{found.reduced_chi2_law:.2f} (Rutherford's law)"
    )


def _picture(path: Path, metals: list[MetalComparison]) -> Path:
    figure, _ = new_panels([True], (7.0, 6.5))
    axes, ratios = figure.axes
    axes.axvspan(*_FITTED, color="0.96", linewidth=0.0, zorder=-2, label="scale fitted here")
    for found in metals:
        found.plot(ax=axes, residuals=ratios)
    figure.savefig(path, dpi=150)
    return path


def __dir__() -> list[str]:
    return list(__all__)
