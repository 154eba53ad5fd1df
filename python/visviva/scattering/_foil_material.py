"""What foils are made of and what flies through them: a small table with its sources, and one's own."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from visviva._arrays import float_array, positive
from visviva._html import Record
from visviva._keywords import did_you_mean, known_keywords
from visviva._parameter import wrapped
from visviva.errors import InvalidInput
from visviva.potentials import Coulomb, Potential, ScreenedCoulomb

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

__all__ = ["Ion", "Material", "ion_of", "losses_of", "material_of", "potential_of", "screened"]

_E2 = 14.399645478  # e²/4πε₀ in eV Å
_SCREENINGS = ("zbl", "moliere", "kr_c", "lenz_jensen", "thomas_fermi", "coulomb")

# Standard atomic weights: IUPAC 2021 (T. Prohaska et al., Pure Appl. Chem. 94 (2022) 573).
_WEIGHTS = {
    "H": (1, 1.008),
    "Be": (4, 9.0121831),
    "C": (6, 12.011),
    "N": (7, 14.007),
    "O": (8, 15.999),
    "Al": (13, 26.9815384),
    "Si": (14, 28.085),
    "Ti": (22, 47.867),
    "Fe": (26, 55.845),
    "Ni": (28, 58.6934),
    "Cu": (29, 63.546),
    "Ge": (32, 72.630),
    "Ag": (47, 107.8682),
    "Ta": (73, 180.94788),
    "W": (74, 183.84),
    "Pt": (78, 195.084),
    "Au": (79, 196.966570),
    "Pb": (82, 207.2),
}
# Densities in g/cm³ and mean excitation energies in eV: ICRU Report 37 (1984), tables 4.3 and 5.5, as in ICRU Report 49
# and NIST's PSTAR and ASTAR. Carbon is amorphous.
_MATERIALS: dict[str, tuple[dict[str, float], float, float]] = {
    "beryllium": ({"Be": 1}, 1.848, 63.7),
    "carbon": ({"C": 1}, 2.0, 81.0),
    "aluminum": ({"Al": 1}, 2.699, 166.0),
    "silicon": ({"Si": 1}, 2.33, 173.0),
    "titanium": ({"Ti": 1}, 4.54, 233.0),
    "iron": ({"Fe": 1}, 7.874, 286.0),
    "nickel": ({"Ni": 1}, 8.902, 311.0),
    "copper": ({"Cu": 1}, 8.96, 322.0),
    "germanium": ({"Ge": 1}, 5.323, 350.0),
    "silver": ({"Ag": 1}, 10.5, 470.0),
    "tantalum": ({"Ta": 1}, 16.65, 718.0),
    "tungsten": ({"W": 1}, 19.3, 727.0),
    "platinum": ({"Pt": 1}, 21.45, 790.0),
    "gold": ({"Au": 1}, 19.32, 790.0),
    "lead": ({"Pb": 1}, 11.35, 823.0),
    "water": ({"H": 2, "O": 1}, 1.0, 75.0),
    "silicon_dioxide": ({"Si": 1, "O": 2}, 2.32, 139.2),
    "mylar": ({"C": 10, "H": 8, "O": 4}, 1.4, 78.7),
}
# Nuclear masses in u: CODATA 2018.
_IONS = {
    "proton": (1, 1.007276466621),
    "deuteron": (1, 2.013553212745),
    "triton": (1, 3.01550071621),
    "helion": (2, 3.014932247175),
    "alpha": (2, 4.001506179127),
}


@known_keywords
@dataclass(frozen=True, repr=False)
class Ion(Record):
    """What flies through a foil.

    `Foil` also takes ``"proton"``, ``"deuteron"``, ``"triton"``, ``"helion"`` and ``"alpha"``.

    Parameters
    ----------
    atomic_number : float
        Of its nucleus, without dimension.
    mass : float
        In u.

    Raises
    ------
    InvalidInput
        For a number that is not positive.

    Examples
    --------
    >>> import visviva as vv
    >>> vv.scattering.Ion(18, 39.948)  # argon
    Ion(atomic_number=18.0, mass=39.948)
    """

    atomic_number: float
    mass: float

    def __post_init__(self) -> None:
        for name in ("atomic_number", "mass"):
            object.__setattr__(self, name, positive(name, getattr(self, name)))


@known_keywords
@dataclass(frozen=True, repr=False)
class Material(Record):
    """Amorphous matter of one element or more.

    `Foil` also takes a name: ``"beryllium"``, ``"carbon"`` (amorphous), ``"aluminum"``, ``"silicon"``, ``"titanium"``,
    ``"iron"``, ``"nickel"``, ``"copper"``, ``"germanium"``, ``"silver"``, ``"tantalum"``, ``"tungsten"``,
    ``"platinum"``, ``"gold"``, ``"lead"``, ``"water"``, ``"silicon_dioxide"``, ``"mylar"``.

    Parameters
    ----------
    density : float
        In g/cm³.
    atomic_number : float or sequence of float
        Of each element.
    mass : float or sequence of float
        Of an atom of each, in u.
    fraction : float or sequence of float, optional
        Of the atoms; only their ratios count. Equal by default.
    mean_excitation_energy : float or sequence of float, optional
        In eV: one for all, or of each element (their losses add: Bragg's rule). Bethe's stopping needs it.

    Raises
    ------
    InvalidInput
        For what is not positive, or lists that do not go together.

    References
    ----------
    The table: ICRU Report 37 (1984); T. Prohaska et al., Pure Appl. Chem. 94 (2022) 573.

    Examples
    --------
    >>> import visviva as vv
    >>> silica = vv.scattering.Material(2.2, [14, 8], [28.085, 15.999], [1, 2], mean_excitation_energy=139.2)
    >>> round(silica.number_density, 4)  # atoms in a cubic ångström
    0.0662
    """

    density: float
    atomic_number: tuple[float, ...]
    mass: tuple[float, ...]
    fraction: tuple[float, ...] = ()
    mean_excitation_energy: tuple[float, ...] | None = None

    def __init__(
        self,
        density: float,
        atomic_number: ArrayLike,
        mass: ArrayLike,
        fraction: ArrayLike | None = None,
        mean_excitation_energy: ArrayLike | None = None,
    ) -> None:
        numbers = _several("atomic_number", atomic_number)
        given: dict[str, object] = {"mass": mass, "fraction": (1.0,) * len(numbers) if fraction is None else fraction}
        if mean_excitation_energy is not None:
            one = np.ndim(mean_excitation_energy) == 0
            given["mean_excitation_energy"] = (
                (mean_excitation_energy,) * len(numbers) if one else mean_excitation_energy
            )
        for name, value in given.items():
            values = _several(name, value)
            if len(values) != len(numbers):
                raise InvalidInput(name, f"expected one for each of {len(numbers)} elements, got {len(values)}")
            object.__setattr__(self, name, values)
        object.__setattr__(self, "density", positive("density", density))
        object.__setattr__(self, "atomic_number", numbers)

    @property
    def number_density(self) -> float:
        """Atoms in a cubic ångström, in units of Å⁻³."""
        parts = np.array(self.fraction) / sum(self.fraction)
        return float(self.density * 0.602214076 / (parts @ np.array(self.mass)))


def _several(name: str, value: Any) -> tuple[float, ...]:
    array = float_array(name, [value] if np.ndim(value) == 0 else value, (None,))
    if not array.size or not (array > 0.0).all():
        raise InvalidInput(name, f"expected one or more positive numbers, got {array.tolist()}")
    return tuple(array.tolist())


def material_of(given: object) -> Material:
    """Give the material of a name, or the one that is given."""
    if isinstance(given, Material):
        return given
    if not isinstance(given, str) or given not in _MATERIALS:
        hint = did_you_mean(given, _MATERIALS) if isinstance(given, str) else ""
        known = ", ".join(_MATERIALS)
        for name, (parts, *_) in _MATERIALS.items():
            if isinstance(given, str) and [given] == list(parts):
                hint = f"; did you mean {name!r}?"
        raise InvalidInput("material", f"expected a Material or one of {known}, got {given!r}{hint}")
    parts, density, excitation = _MATERIALS[given]
    numbers, masses = zip(*(_WEIGHTS[symbol] for symbol in parts), strict=True)
    return Material(density, numbers, masses, tuple(parts.values()), excitation)


def ion_of(given: object) -> Ion:
    """Give the ion of a name, or the one that is given."""
    if isinstance(given, Ion):
        return given
    if not isinstance(given, str) or given not in _IONS:
        hint = did_you_mean(given, _IONS) if isinstance(given, str) else ""
        raise InvalidInput("ion", f"expected an Ion or one of {', '.join(_IONS)}, got {given!r}{hint}")
    return Ion(*_IONS[given])


def losses_of(stopping: Any) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Give the table of a stopping that is measured."""
    if not isinstance(stopping, tuple) or len(stopping) != 2:
        raise InvalidInput("stopping", f"expected a name or a tuple (energy, loss) of two lists, got {stopping!r}")
    energy, loss = (float_array("stopping", column, (None,)) for column in stopping)
    if len(energy) != len(loss):
        raise InvalidInput("stopping", f"expected a loss at each of {len(energy)} energies, got {len(loss)}")
    return tuple(energy.tolist()), tuple(loss.tolist())


def potential_of(given: Any, several: int) -> Any:
    """Give the name of a screening, or a tuple of one potential for each of several elements."""
    if isinstance(given, str):
        if given not in _SCREENINGS:
            hint = did_you_mean(given, _SCREENINGS)
            raise InvalidInput(
                "potential", f"expected one of {', '.join(_SCREENINGS)}, or a Potential, got {given!r}{hint}"
            )
        return given
    each = (given,) if isinstance(given, Potential) else given
    if not isinstance(each, Sequence) or not all(isinstance(one, Potential) for one in each):
        raise InvalidInput("potential", f"expected a name or one of visviva.potentials, got {given!r}{wrapped(given)}")
    if len(each) != several:
        raise InvalidInput("potential", f"expected one for each of {several} elements, got {len(each)}")
    return tuple(each)


def screened(name: Any, first: float, second: float) -> Potential:
    """Give the potential between two nuclei with that screening, in eV and Å."""
    if name == "coulomb":
        return Coulomb(_E2 * first * second)
    made: Potential = ScreenedCoulomb.between(first, second, name)
    return made
