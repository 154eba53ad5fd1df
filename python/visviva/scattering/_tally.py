"""The integer histogram of one quantity of a beam's events, its cross section and its picture."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from visviva import _core
from visviva._html import Record, brief_tuple
from visviva._keywords import known_keywords
from visviva._made_by import made_by
from visviva.errors import InvalidInput
from visviva.scattering._counts import plot_tally, poisson_interval
from visviva.scattering._exported import OfOneQuantity, OfStrata
from visviva.scattering._weights import added_strata, read_only, same, variances, weighted_counts

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from visviva.scattering._beam import Beam
    from visviva.typing import TallyName

__all__ = ["CrossSection", "Tally", "area_of_events", "measure", "told"]

_ANGLES = ("cm_angle", "lab_angle", "recoil_angle")


@known_keywords
class CrossSection(NamedTuple):
    """A cross section by bin and its standard error; NaN in a bin that the beam does not reach.

    Both have shape (B,), of two quantities together (B₁, B₂), and are in the units of b_max² per steradian for angles,
    else over those of the quantity.

    Examples
    --------
    >>> import visviva as vv
    >>> run = vv.scattering.monte_carlo(
    ...     vv.potentials.HardSphere(1.0), beam_energy=1.0, masses=(1.0, 4.0), b_max=1.0,
    ...     n_events=1000, seed=1, bins=4)
    >>> sigma = run["cm_angle"].cross_section()
    >>> sigma.value.shape, bool((abs(sigma.value - 0.25) < 4.0 * sigma.error).all())  # R²/4
    ((4,), True)
    """

    value: NDArray[np.float64]
    """Area per steradian for angles, else area per unit of the quantity."""
    error: NDArray[np.float64]
    """One standard deviation of the count, as an area likewise."""

    def __repr__(self) -> str:
        return brief_tuple(self)


def measure(name: str, edges: NDArray[np.float64]) -> NDArray[np.float64]:
    """Of each bin the solid angle, or the width."""
    return _core.solid_angles(edges) if name in _ANGLES else np.diff(edges)


def told(name: str, reachable: NDArray[np.float64], beam: Beam) -> NDArray[np.float64]:
    """Of each bin the part over which a cross section is averaged: none where events of another branch fall in."""
    two_branches = name == "lab_angle" and beam.masses[0] > beam.masses[1]
    return np.where(reachable == 1.0, 1.0, 0.0) if two_branches else reachable


def area_of_events(
    beam: Beam, n_events: int, widths: NDArray[np.float64], parts: NDArray[np.float64]
) -> NDArray[np.float64]:
    """What one event of each bin adds to its cross section; NaN where there is no part of the bin.

    Raises
    ------
    InvalidInput
        For a beam with a spot.
    """
    if beam.spot is not None:
        raise InvalidInput("spot", f"expected a beam that fills the disc evenly, got a spot of {beam.spot}")
    scale = np.full(widths.shape, np.nan)
    known = parts > 0.0
    scale[known] = np.pi * beam.b_max**2 / (n_events * (widths * parts)[known])
    return scale


@known_keywords
@dataclass(frozen=True, eq=False, repr=False)
class Tally(OfStrata, OfOneQuantity, Record):  # noqa: PLW1641 — it holds arrays, which have no hash
    """A histogram of one quantity. Bin i holds ``edges[i] ≤ x < edges[i+1]``; the last one also its end.

    Tallies of the same quantity, beam and edges add up if no event is in both, and are equal if all of it is.

    Units: energies and lengths are those of the potential, masses in one unit, any; angles in radians.

    Attributes
    ----------
    name : str
        The quantity.
    edges : ndarray, shape (B + 1,)
        Strictly increasing.
    counts : ndarray of uint64, shape (B,)
        Events per bin.
    underflow, overflow : int
        Events below the first and above the last edge.
    captured : int
        Events that fell into the center and so have no such quantity.
    reachable : ndarray, shape (B,)
        For each bin the part of it (of its solid angle for angles, else of its width) whose impact parameters all
        lie on the disc: 1 for a bin that is reached whole, 0 for one that is not, between for one that the edge of
        the disc cuts. What a rainbow, a glory or orbits beyond the disc lead to is not reached, and bins that hold any
        of it are 0, however much comes from within.
    covered : tuple of float
        The values (low, high) whose impact parameters all lie on the disc.
    beam : Beam
        What was scattered by what.
    events : tuple
        Which events: sorted (seed, first, end) with end excluded.
    n_events : int
        Events in all: the sum of ``counts``, ``underflow``, ``overflow`` and ``captured``.
    b_max : float
        Radius of the disc of impact parameters.
    by_stratum : ndarray of uint64, shape (S, B + 3), or None
        With `importance` the events of each stratum: below the first edge, in the bins, above the last, and captured.

    References
    ----------
    F. James, *Statistical Methods in Experimental Physics*, 2nd ed. (2006), ch. 4 (binomial and multinomial counts).

    Examples
    --------
    >>> import visviva as vv
    >>> run = vv.scattering.monte_carlo(
    ...     vv.potentials.HardSphere(1.0), beam_energy=1.0, masses=(1.0, 4.0), b_max=1.0,
    ...     n_events=1000, seed=1, bins=4)
    >>> tally = run["cm_angle"]
    >>> tally.name, tally.edges.round(3), int(tally.counts.sum())
    ('cm_angle', array([0.   , 0.785, 1.571, 2.356, 3.142]), 1000)
    """

    name: TallyName
    edges: NDArray[np.float64]
    counts: NDArray[np.uint64]
    underflow: int
    overflow: int
    reachable: NDArray[np.float64]
    covered: tuple[float, float]
    beam: Beam
    events: tuple[tuple[int, int, int], ...]
    captured: int = 0
    by_stratum: NDArray[np.uint64] | None = None

    def __post_init__(self) -> None:
        arrays = {"edges": self.edges, "counts": self.counts, "reachable": self.reachable}
        arrays |= {} if self.by_stratum is None else {"by_stratum": self.by_stratum}
        made_by(self, "visviva.scattering.monte_carlo", **{name: (array, np.ndarray) for name, array in arrays.items()})
        read_only(*arrays.values())

    def values(self) -> NDArray[np.float64]:
        """Counts as float64, exact up to 2⁵³; with `importance` Σ w n over the strata, w their weights.

        Returns
        -------
        ndarray, shape (B,)
            Without dimension.

        Examples
        --------
        >>> import visviva as vv
        >>> run = vv.scattering.monte_carlo(
        ...     vv.potentials.HardSphere(1.0), beam_energy=1.0, masses=(1.0, 4.0), b_max=1.0,
        ...     n_events=1000, seed=1, bins=4)
        >>> float(run["cm_angle"].values().sum())
        1000.0
        """
        return weighted_counts(self, 1, self.counts, (slice(1, -2),))

    def variances(self) -> NDArray[np.float64]:
        """Variances of the values, n·(1 − n/N), binomial: the number N of events is fixed.

        With `importance` Σ w² n − (Σ w n)²/N, multinomial, which is the same where all
        weights are 1.

        Returns
        -------
        ndarray, shape (B,)
            Without dimension.

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> run = vv.scattering.monte_carlo(
        ...     vv.potentials.HardSphere(1.0), beam_energy=1.0, masses=(1.0, 4.0), b_max=1.0,
        ...     n_events=1000, seed=1, bins=4)
        >>> n = run["cm_angle"].counts
        >>> bool(np.allclose(run["cm_angle"].variances(), n * (1.0 - n / 1000.0)))
        True
        """
        return variances(self.values(), weighted_counts(self, 2, self.counts, (slice(1, -2),)), self.n_events)

    def poisson_interval(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """The exact central 68.27 % intervals of the means that counts come from.

        Returns
        -------
        tuple of ndarray, shape (B,)
            Lower ends μ with P(N ≥ n; μ) = 15.87 %, 0 where nothing was counted; upper ends, P(N ≤ n; μ) = 15.87 %:
            about n ± √n where counts are large, [0, 1.84] where there is none. Numbers without dimension.

        Raises
        ------
        InvalidInput
            With `importance`, of which events differ in weight: see `variances`.

        References
        ----------
        F. Garwood, *Fiducial limits for the Poisson distribution*, Biometrika **28**, 437 (1936).

        Examples
        --------
        >>> import visviva as vv
        >>> tally = vv.scattering.monte_carlo(
        ...     vv.potentials.HardSphere(1.0), beam_energy=1.0, masses=(1.0, 4.0), b_max=1.0, n_events=1, seed=1,
        ...     tally={"cm_angle": [0.0, 1.0, 3.1]})["cm_angle"]
        >>> low, high = tally.poisson_interval()
        >>> sorted(low.round(3).tolist()), sorted(high.round(3).tolist())
        ([0.0, 0.173], [1.841, 3.3])
        """
        if self.by_stratum is not None:
            raise InvalidInput("importance", "expected events of one weight, got strata; variances() has their errors")
        return poisson_interval(self.counts)

    def plot(self, *, ax: Axes | None = None, residuals: Axes | None = None) -> Axes:
        """Draw counts as a cross section of the disc, with Poisson bands, beside what is expected where that is known.

        The bands are those of `poisson_interval`, not √n; with `importance` one standard deviation. Where the disc does
        not reach, the simulation and `expected` lack the same. A panel below shows what is left, (n − theory)/σ with σ
        of the number that is expected, within a band of one σ, of bins in which one event is expected at least; with
        `importance` σ is that of `variances`, of bins that have counted something.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Where to draw the counts; by default in a new figure, ``.figure`` of what is returned, whose
            ``.figure.axes[1]`` is the panel below where something is expected.
        residuals : matplotlib.axes.Axes, optional
            With `ax`, where what is left goes; without it, it is not drawn.

        Returns
        -------
        matplotlib.axes.Axes
            Of the counts.

        Raises
        ------
        InvalidInput
            If matplotlib is not installed; for `residuals` without `ax` or where nothing is expected.

        Examples
        --------
        >>> import visviva as vv
        >>> run = vv.scattering.monte_carlo(
        ...     vv.potentials.HardSphere(1.0), beam_energy=1.0, masses=(1.0, 4.0), b_max=1.0,
        ...     n_events=1000, seed=1, bins=4)
        >>> [axes.get_ylabel() for axes in run["cm_angle"].plot().figure.axes]
        ['dσ/dΩ [area per steradian]', '(n − theory) / σ']
        """
        return plot_tally(self, ax, residuals)

    def _measure(self) -> NDArray[np.float64]:
        return measure(self.name, self.edges)

    def cross_section(self) -> CrossSection:
        """Differential cross section averaged over each bin, as far as the bin is `reachable`.

        A bin that the edge of the disc cuts is averaged over its reachable part, and one that is not reached is NaN, so
        that forward directions are missing of a potential that does not end within ``b_max``. Of a heavy projectile
        (m₁ > m₂) two impact parameters lead to one laboratory angle: below ``covered[0]`` one of them is beyond the
        disc, and bins that begin there are NaN, the cut one too.

        Returns
        -------
        CrossSection
            (value, error): counts / n_events · π b_max², per steradian for angles, else per unit of the quantity;
            shape (B,), in the units of b_max².

        Raises
        ------
        InvalidInput
            For a beam with a spot, which does not fill the disc evenly.

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> result = vv.scattering.monte_carlo(
        ...     vv.potentials.Coulomb(1.0), beam_energy=1.0, masses=(1.0, 1e9), b_max=2.0, n_events=100_000, seed=1,
        ...     tally={"cm_angle": np.radians([0, 20, 90, 180])})
        >>> tally = result["cm_angle"]
        >>> np.degrees(tally.covered).round(3)
        array([ 28.072, 180.   ])
        >>> tally.reachable.round(3)
        array([0.   , 0.939, 1.   ])
        >>> value, error = tally.cross_section()
        >>> bool(np.isnan(value[0])), bool(abs(value[2] * 2 * np.pi - np.pi / 4) < 4 * error[2] * 2 * np.pi)
        (True, True)
        """
        scale = area_of_events(self.beam, self.n_events, self._measure(), told(self.name, self.reachable, self.beam))
        return CrossSection(self.values() * scale, np.sqrt(self.variances()) * scale)

    def _axes(self) -> tuple[tuple[str, NDArray[np.float64]], ...]:
        return ((self.name, self.edges),)

    def _whole(self) -> NDArray[np.uint64]:
        return np.concatenate([[self.underflow], self.counts, [self.overflow]]).astype(np.uint64)

    def _columns(self) -> dict[str, NDArray[Any]]:
        return {"counts": self.counts, "reachable": self.reachable} | super()._columns()

    def _about(self) -> dict[str, int]:
        return {name: getattr(self, name) for name in ("underflow", "overflow", "captured", "n_events")}

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Tally):
            return NotImplemented
        numbers = ("name", "underflow", "overflow", "captured", "beam", "events")
        return all(getattr(self, name) == getattr(other, name) for name in numbers) and all(
            same(getattr(self, name), getattr(other, name)) for name in ("edges", "counts", "by_stratum")
        )

    def __add__(self, other: Tally) -> Tally:
        if not isinstance(other, Tally):
            return NotImplemented
        if self.name != other.name or not np.array_equal(self.edges, other.edges):
            raise InvalidInput("other", f"expected a tally of {self.name} with the same edges, got one of {other.name}")
        return replace(
            self,
            counts=self.counts + other.counts,
            underflow=self.underflow + other.underflow,
            overflow=self.overflow + other.overflow,
            captured=self.captured + other.captured,
            events=self._merged_events(other),
            by_stratum=added_strata(self.by_stratum, other.by_stratum),
        )
