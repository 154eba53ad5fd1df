"""Where the events of a Monte Carlo are wanted: strata of the impact parameter, and what they weigh."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from visviva import _core
from visviva._arrays import float_array, number, positive, whole_number
from visviva._html import Record
from visviva._keywords import known_keywords
from visviva.errors import InvalidInput
from visviva.scattering._beam import Spectrum
from visviva.scattering._structure import impact_parameter

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from visviva.scattering._beam import Beam

__all__ = ["LargeAngles", "Strata", "strata_of"]

_MOST, _LEAST = 2**10, 1e-6


@known_keywords
@dataclass(frozen=True, repr=False)
class Strata(Record):
    """Rings of impact parameters, each with its part of the events of a Monte Carlo.

    In each ring b² is uniform, and each of its events stands for equally many of a beam that fills the disc evenly.
    Even a ring of 1e-150 of the radius of the disc keeps the relative precision of impact parameters.

    Units: radii in those of the potential's lengths; fractions are without dimension.

    Parameters
    ----------
    edges : array_like, shape (S + 1,)
        Impact parameters that rise from 0 to ``b_max``; up to 1024 rings.
    fractions : array_like, shape (S,), optional
        The part of the events in each, of which only the ratios count; none below 1e-6 of the sum. By default equal.

    Raises
    ------
    InvalidInput
        For radii that do not rise from 0, more than 1024 rings, a part that is below 1e-6 of the sum, or another number
        of parts than of rings.

    References
    ----------
    J. M. Hammersley, D. C. Handscomb, *Monte Carlo Methods* (1964), ch. 5 (stratified and importance sampling).

    Examples
    --------
    Half of the events within a hundredth of the disc's radius, a ten-thousandth of its area:

    >>> import visviva as vv
    >>> strata = vv.scattering.Strata([0.0, 0.02, 2.0])
    >>> strata.weights.round(4)
    array([2.0000e-04, 1.9998e+00])
    >>> run = vv.scattering.monte_carlo(
    ...     vv.potentials.Coulomb(1.0), beam_energy=1.0, masses=(1.0, 1e9), b_max=2.0, n_events=10_000, seed=1,
    ...     tally={"cm_angle": [0.0, 3.1, 3.141592653589793]}, importance=strata)
    >>> run["cm_angle"].counts.tolist()[1] > 1200, bool(abs(run["cm_angle"].values()[1] - 0.27) < 0.04)
    (True, True)
    """

    edges: tuple[float, ...]
    fractions: tuple[float, ...] = ()

    def __init__(self, edges: ArrayLike, fractions: ArrayLike | None = ()) -> None:
        radii = float_array("edges", edges, (None,)).tolist()
        # None and nothing at all are the default.
        given = () if fractions is None else fractions
        parts = float_array("fractions", given, (None,)).tolist() or [1.0] * max(0, len(radii) - 1)
        _core.strata_weights(radii, parts)
        object.__setattr__(self, "edges", tuple(radii))
        object.__setattr__(self, "fractions", tuple(parts))

    @property
    def weights(self) -> NDArray[np.float64]:
        """How many events of the plain disc one of each ring stands for, shape (S,), without dimension.

        The ring's part of the disc by its part of the 2⁵³ draws: exactly those that lead there, so nothing is biased by
        rounding a fraction.
        """
        return np.array(_core.strata_weights(list(self.edges), list(self.fractions)))

    @staticmethod
    @known_keywords
    def logarithmic(n: int, smallest: float, b_max: float) -> Strata:
        """Make rings whose radii have equal ratios, with equal parts of the events: as many for each decade of b.

        Units: radii in those of the potential's lengths; fractions are without dimension.

        Parameters
        ----------
        n : int
            How many, 2 to 1024, the innermost disc among them.
        smallest : float
            Radius of the innermost disc, positive.
        b_max : float
            Radius of the disc.

        Returns
        -------
        Strata

        Raises
        ------
        InvalidInput
            For a number of rings outside 2 to 1024, a radius that is not positive, or an innermost disc that is not
            smaller than the whole.

        Examples
        --------
        >>> import visviva as vv
        >>> [round(edge, 12) for edge in vv.scattering.Strata.logarithmic(4, 1e-3, 1.0).edges]
        [0.0, 0.001, 0.01, 0.1, 1.0]
        """
        count = whole_number("n", n, 2, _MOST)
        inner, outer = positive("smallest", smallest), positive("b_max", b_max)
        if inner >= outer:
            raise InvalidInput("smallest", f"expected less than b_max = {outer}, got {inner}")
        return Strata((0.0, *_core.strata_edges(count - 1, inner, outer)))


@known_keywords
@dataclass(frozen=True, repr=False)
class LargeAngles(Record):
    """Force a part of the events of a Monte Carlo to be within what is deflected by more than some angle.

    The disc is divided at the greatest impact parameter that leads to the angle, of all branches and of all energies of
    the beam: within it are all events that are deflected by more, with others, if there are any, and beyond it none.

    Parameters
    ----------
    smallest_angle : float
        From the beam, in the center-of-mass frame: in radians, in (0, π).
    fraction : float, optional
        The part of the events within, 1e-6 to 1 − 1e-6.

    Raises
    ------
    InvalidInput
        For an angle outside (0, π), or a part that is not between 1e-6 and 1 − 1e-6.

    References
    ----------
    J. M. Hammersley, D. C. Handscomb, *Monte Carlo Methods* (1964), ch. 5 (stratified and importance sampling).

    Examples
    --------
    Backscattering of one alpha particle in a million, to a thousandth with a million of events:

    >>> import numpy as np, visviva as vv
    >>> run = vv.scattering.monte_carlo(
    ...     vv.potentials.Coulomb(1.0), beam_energy=0.5, masses=(1.0, 1e9), b_max=1000.0, n_events=1_000_000, seed=1,
    ...     tally={"cm_angle": [0.0, np.pi / 2, np.pi]}, importance=vv.scattering.LargeAngles(np.pi / 2))
    >>> sigma, error = run["cm_angle"].cross_section()
    >>> exact = np.pi / (2.0 * np.pi)  # πκ² in the backward half space, κ = 1
    >>> bool(abs(sigma[1] - exact) < 4 * error[1]), bool(error[1] < 1.1e-3 * sigma[1])
    (True, True)
    """

    smallest_angle: float
    fraction: float = 0.5

    def __post_init__(self) -> None:
        angle, fraction = number("smallest_angle", self.smallest_angle), number("fraction", self.fraction)
        if not 0.0 < angle < np.pi:
            raise InvalidInput(
                "smallest_angle", f"expected radians in (0, π), got {angle}; pass np.radians(…) of degrees"
            )
        if not _LEAST <= fraction <= 1.0 - _LEAST:
            raise InvalidInput("fraction", f"expected a part of the events, 1e-6 to 1 - 1e-6, got {fraction}")
        object.__setattr__(self, "smallest_angle", angle)
        object.__setattr__(self, "fraction", fraction)


def strata_of(given: object, beam: Beam) -> Strata | None:
    """The strata of a beam."""
    if given is None or isinstance(given, Strata):
        return given
    if not isinstance(given, LargeAngles):
        raise InvalidInput("importance", f"expected Strata, LargeAngles or None, got {given!r}")
    light, heavy = beam.masses
    if not (min(light, heavy) > 0.0 and np.isfinite(light + heavy)):
        raise InvalidInput("masses", f"expected positive finite numbers, got {beam.masses}")
    share = heavy / (light + heavy)
    energies = beam.beam_energy.energy if isinstance(beam.beam_energy, Spectrum) else (beam.beam_energy,)
    if beam.energy_spread is not None:
        reach = beam.energy_spread.width * (6.0 if beam.energy_spread.shape == "gaussian" else 1.0)
        energies = tuple(energy + part * reach for energy in energies for part in (-1.0, 0.0, 1.0))
    if not min(energies) > 0.0:
        raise InvalidInput("beam_energy", f"expected positive energies, got {min(energies)}")
    angle = given.smallest_angle
    reached = [impact_parameter(beam.potential, energy=energy * share, angle=angle) for energy in energies]
    within = max((float(b.max()) for b in reached if b.size), default=0.0)
    if not within > 0.0:
        raise InvalidInput("importance", f"expected an angle that is reached, got {angle}: no deflection is as large")
    if not within < beam.b_max:
        raise InvalidInput(
            "importance",
            f"expected an angle that only a part of the disc reaches, got {angle}, which b = {within} leads to; "
            f"choose a greater angle, or b_max above that",
        )
    return Strata((0.0, within, beam.b_max), (given.fraction, 1.0 - given.fraction))
