"""Ions through amorphous matter: what is asked for, checked, and followed by the core."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal, TypeAlias

import numpy as np

from visviva import _core
from visviva._arrays import number, positive, positive_array
from visviva._html import Record
from visviva._keywords import known_keywords, one_of
from visviva.errors import InvalidInput
from visviva.scattering._arguments import in_radians
from visviva.scattering._bins import asked_for
from visviva.scattering._foil_material import Ion, Material, ion_of, losses_of, material_of, potential_of, screened
from visviva.scattering._foil_result import USUAL_TALLIES, Bombardment, FoilResult
from visviva.scattering._spread import event_range

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from numpy.typing import ArrayLike, NDArray

    from visviva.potentials import Potential
    from visviva.scattering._bins import Bins
    from visviva.typing import Executor, FoilTallyName, IonHistory, IonName, MaterialName, Progress, ScreeningName

__all__ = ["Foil"]

Stopping: TypeAlias = Literal["joined", "bethe", "lindhard_scharff", "none"]


@known_keywords
@dataclass(frozen=True, repr=False)
class Foil(Record):
    """A foil of amorphous matter, through which ions are followed collision by collision.

    Energies are in eV, lengths of the foil in µm, masses in u, angles in radians; a potential is in eV and Å.

    An ion flies straight, an exponentially distributed way, and electrons slow it down; then an atom turns it. The
    impact parameter is uniform over the disc of all collisions that turn by ``minimum_angle`` or more, as wide at most
    as atoms are apart; the azimuth is uniform. Not in the model: straggling of the electronic loss, channeling,
    displacement of target atoms, and relativistic kinematics of the collisions.

    Parameters
    ----------
    material : Material or str
        What it is made of: see `Material`.
    thickness : float
        In µm.
    potential : str, Potential or sequence of Potential, optional
        Between an ion and an atom: the name of a screening function (``"zbl"``, ``"moliere"``, ``"kr_c"``,
        ``"lenz_jensen"``, ``"thomas_fermi"``; see `potentials.ScreenedCoulomb.between`), ``"coulomb"`` for bare nuclei,
        or V(r) itself in eV and Å, of each element in turn where there are several.
    stopping : {"joined", "bethe", "lindhard_scharff", "none"} or two array_like, shape (P,), optional
        What electrons take. ``"lindhard_scharff"``: in proportion to the speed, right for slow ions. ``"bethe"``: right
        for fast ones, 2mv² ≫ I, continued in proportion to the speed below its greatest value. ``"joined"``, for all
        energies: 1/S is the sum of both inverses, with Bethe's logarithm continued as Biersack and Haggmark did; within
        10 % of what is measured of protons and alphas from 1 MeV per nucleon on. Below it is rough: 30 % too much of
        protons of 10 keV in water, 25 % at 50 keV, 18 % too little of alphas of 2 MeV in gold. ``"none"``: nothing.
        Where more is known (for slow ions take a table), ``(energy, loss)``: increasing energies in eV and what is lost
        there in eV/µm, between which logarithms are straight lines; below the first the loss is in proportion to the
        speed.
    minimum_angle : float, optional
        Collisions that turn by less, in the center-of-mass frame, are left out. It is an angle and no energy, so that
        small angles are not biased (Mendenhall and Weller). It should be small against the width of what comes through.

    Raises
    ------
    InvalidInput
        For any argument out of range, by name.

    References
    ----------
    J. F. Ziegler, J. P. Biersack, U. Littmark, *The Stopping and Range of Ions in Solids* (1985); J. Lindhard,
    M. Scharff, Phys. Rev. 124 (1961) 128; J. P. Biersack, L. G. Haggmark, Nucl. Instrum. Methods 174 (1980) 257;
    M. H. Mendenhall, R. A. Weller, Nucl. Instrum. Methods B 227 (2005) 420.

    Examples
    --------
    >>> import visviva as vv
    >>> foil = vv.scattering.Foil("gold", 0.4)
    >>> out = foil.run("alpha", beam_energy=7.687e6, n_events=1000, seed=1)
    >>> out.transmitted + out.reflected + out.stopped
    1000
    """

    material: Material
    thickness: float
    potential: ScreeningName | Literal["coulomb"] | tuple[Potential, ...] = "zbl"
    stopping: Stopping | tuple[tuple[float, ...], tuple[float, ...]] = "joined"
    minimum_angle: float = 1e-4

    def __init__(
        self,
        material: Material | MaterialName,
        thickness: float,
        *,
        potential: ScreeningName | Literal["coulomb"] | Potential | Sequence[Potential] = "zbl",
        stopping: Stopping | tuple[ArrayLike, ArrayLike] = "joined",
        minimum_angle: float = 1e-4,
    ) -> None:
        checked_material = material_of(material)
        given = {
            "material": checked_material,
            "thickness": positive("thickness", thickness),
            "potential": potential_of(potential, len(checked_material.atomic_number)),
            "stopping": stopping if isinstance(stopping, str) else losses_of(stopping),
            "minimum_angle": number("minimum_angle", minimum_angle),
        }
        for name, value in given.items():
            object.__setattr__(self, name, value)
        with in_radians(minimum_angle=self.minimum_angle):
            _core.check_foil(self._described(Ion(1.0, 1.0)))

    def _described(self, ion: Ion) -> dict[str, Any]:
        """What the core is told."""
        material = self.material
        if isinstance(self.potential, str):
            potentials = [screened(self.potential, ion.atomic_number, other) for other in material.atomic_number]
        else:
            potentials = list(self.potential)
        excitations = material.mean_excitation_energy or (np.nan,) * len(potentials)
        columns = zip(material.atomic_number, material.mass, material.fraction, excitations, potentials, strict=True)
        named = ("atomic_number", "mass", "fraction", "excitation", "potential")
        return {
            "elements": [
                dict(zip(named, (*numbers, potential._to_core()), strict=True)) for *numbers, potential in columns
            ],
            "density": material.density,
            "thickness": self.thickness * 1e4,
            "stopping": self.stopping
            if isinstance(self.stopping, str)
            else [(energy, loss / 1e4) for energy, loss in zip(*self.stopping, strict=True)],
            "minimum_angle": self.minimum_angle,
        }

    def run(
        self,
        ion: Ion | IonName,
        *,
        beam_energy: float,
        n_events: int,
        seed: int,
        tally: FoilTallyName | Iterable[FoilTallyName] | Mapping[FoilTallyName, ArrayLike | Bins] = USUAL_TALLIES,
        bins: ArrayLike | Bins | Mapping[FoilTallyName, ArrayLike | Bins] = 180,
        incidence: float = 0.0,
        lowest_energy: float | None = None,
        collisions: Literal["multiple", "single"] = "multiple",
        forced_angle: float | None = None,
        threads: int | None = None,
        first_event: int = 0,
        progress: Progress = False,
        executor: Executor | None = None,
    ) -> FoilResult:
        """Send ions and count what comes through, what comes back and what stops.

        Event i takes its random numbers from stream 1 of Philox 4x32-10 with ``seed`` as the key: counts do not depend
        on threads, processor or partition, and results of separate ranges of events add up to that of the whole.

        Parameters
        ----------
        ion : Ion or str
            What flies: see `Ion`.
        beam_energy : float
            In eV (1 MeV is 1e6): from 30 on, below which an ion meets several atoms at once, to a tenth of its rest
            energy.
        n_events : int
            How many ions, at least 1 and at most 2³⁹.
        seed : int
            0 to 2⁶⁴ − 1.
        tally : str, iterable of str, or mapping, optional
            What to count: ``"transmitted_angle"``, ``"reflected_angle"``, ``"lab_angle"`` (of both) from the beam's
            direction, ``"transmitted_energy"`` and ``"reflected_energy"`` in eV, ``"stopped_depth"`` in µm, and of a
            forced collision ``"cm_angle"``; one name, several, or ``{name: edges}``, where a whole number in place of
            edges is a number of equal bins, and `Bins` are bins by name.
        bins : int, Bins, array_like or mapping, optional
            Of each tally that is given by its name only: as of `monte_carlo`. Edges have shape (B + 1,).
        incidence : float, optional
            Angle between the beam and the foil's normal.
        lowest_energy : float, optional
            An ion of less has stopped; by default a thousandth of ``beam_energy``.
        collisions : {"multiple", "single"}, optional
            ``"single"``: each ion has the forced collision and no other, and flies straight else. What it stands for is
            the expected number of such collisions: the limit of a thin foil.
        forced_angle : float, optional
            Every ion is made to have one collision, at a uniform place on the first 1.25 straight ways through (1 for
            ``"single"``), of all those that turn by this center-of-mass angle or more wherever that is, and stands for
            as many ions as it is likely to, so that ``values()`` are of all that came; large angles are drawn more
            often than they come. Ions without such a collision are not counted: what is counted is whole where nothing
            else leads, far enough beyond this angle.
        threads : int, optional
            By default ``VISVIVA_THREADS``, else all cores.
        first_event : int, optional
            Index of the first event.
        progress : bool or callable, optional
            True for a bar, or ``f(done, total)``.
        executor : concurrent.futures.Executor or dask.distributed.Client, optional
            Who counts: as of `monte_carlo`; each range of events builds its table of angles again.

        Warns
        -----
        AccuracyWarning
            Of a foil that is thinner than atoms are apart, or than the way between two collisions, with the figure; not
            of ``"single"`` collisions, nor, of the latter, beside a forced one.

        Returns
        -------
        FoilResult
            ``out["transmitted_angle"].counts``, ``.values()``, ``.variances()``, ``.fraction()``; ``out.transmitted``.

        Raises
        ------
        InvalidInput
            For any argument out of range, by name; a potential that captures.
        Interrupted
            After Ctrl-C. Its ``.result`` holds the events counted until then, from ``first_event`` without a gap (None
            if there are none yet): with a run of the rest it adds up to the whole, bit for bit.

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> foil = vv.scattering.Foil("gold", 0.4)
        >>> out = foil.run("alpha", beam_energy=7.687e6, n_events=20_000, seed=1, collisions="single",
        ...                forced_angle=np.radians(60), tally={"cm_angle": np.radians([60, 90, 180])})
        >>> value, error = out["cm_angle"].fraction()
        >>> f"{value[1]:.2e}"  # a few in a hundred thousand turn back
        '1.74e-05'
        """
        hit = self._hit(ion, beam_energy, lowest_energy, incidence, collisions, forced_angle)
        asked = asked_for(tally, bins)
        for axes in asked:
            if len(axes) > 1:
                raise InvalidInput("tally", f"expected single quantities, got {tuple(name for name, _ in axes)}")
        with in_radians(incidence=hit.incidence, forced_angle=hit.forced_angle):
            return hit._run(asked, n_events, seed, first_event, threads, progress, executor)

    def history(
        self,
        ion: Ion | IonName,
        *,
        beam_energy: float,
        seed: int,
        event: int = 0,
        incidence: float = 0.0,
        lowest_energy: float | None = None,
        collisions: Literal["multiple", "single"] = "multiple",
        forced_angle: float | None = None,
    ) -> IonHistory:
        """The way of one of the very ions that `run` counts.

        Parameters
        ----------
        ion, beam_energy, seed, incidence, lowest_energy, collisions, forced_angle
            As of `run`.
        event : int, optional
            Which one.

        Returns
        -------
        dict
            Of each collision ``"depth"`` and ``"path"`` until then in µm, ``"element"`` (its place in the material),
            ``"impact_parameter"`` in Å, ``"cm_angle"``, ``"energy"`` before and after, shape (C, 2), and
            ``"direction"`` before and after, shape (C, 2, 3), the third component into the foil; and of the end
            ``"fate"``, ``"final_angle"``, ``"final_energy"``, ``"final_depth"`` and ``"weight"``.

        Raises
        ------
        InvalidInput
            As `run`.

        Examples
        --------
        >>> import visviva as vv
        >>> way = vv.scattering.Foil("gold", 0.4).history("alpha", beam_energy=7.687e6, seed=1)
        >>> way["fate"], bool((way["energy"][:, 1] <= way["energy"][:, 0]).all())
        ('transmitted', True)
        """
        hit = self._hit(ion, beam_energy, lowest_energy, incidence, collisions, forced_angle)
        first, _, key = event_range(event, 1, seed)
        with in_radians(incidence=hit.incidence, forced_angle=hit.forced_angle):
            numbers, directions, elements, end = _core.foil_history(
                foil=self._described(hit.ion), run=hit._to_core(), seed=key, event=first
            )
        fate, angle, energy, depth, weight = end
        return {
            "depth": numbers[:, 0] / 1e4,
            "path": numbers[:, 1] / 1e4,
            "element": elements,
            "impact_parameter": numbers[:, 2].copy(),
            "cm_angle": numbers[:, 3].copy(),
            "energy": numbers[:, 4:].copy(),
            "direction": directions,
            "fate": fate,
            "final_angle": angle,
            "final_energy": energy,
            "final_depth": depth / 1e4,
            "weight": weight,
        }

    def stopping_power(self, ion: Ion | IonName, energy: ArrayLike) -> NDArray[np.float64]:
        """What electrons take of an ion, in eV/µm.

        Parameters
        ----------
        ion : Ion or str
            As of `run`.
        energy : array_like
            In eV.

        Returns
        -------
        ndarray
            Of the shape of `energy`, in eV/µm.

        Raises
        ------
        InvalidInput
            For an energy that is not positive or more than ten times the ion's rest energy (there is no density effect
            in the formula), or a mean excitation energy that is needed and not known.

        Examples
        --------
        >>> import visviva as vv
        >>> round(float(vv.scattering.Foil("silicon", 1.0).stopping_power("alpha", 5.486e6)) / 1e3)  # keV/µm
        127
        """
        return self._losses(ion, energy, None) * 1e4

    def range(self, ion: Ion | IonName, energy: ArrayLike, *, lowest_energy: float) -> NDArray[np.float64]:
        """How far an ion goes in µm until electrons alone have slowed it down: ∫dE/S.

        Parameters
        ----------
        ion : Ion or str
            As of `run`.
        energy : array_like
            In eV.
        lowest_energy : float
            In eV, where the way ends.

        Returns
        -------
        ndarray
            Of the shape of `energy`, in µm.

        Raises
        ------
        InvalidInput
            As `stopping_power`; for an energy below the lowest, or a foil that stops nothing.

        References
        ----------
        ICRU Report 49 (1993), which calls it the range of continuous slowing down; for S see `Foil`.

        Examples
        --------
        >>> import visviva as vv
        >>> foil = vv.scattering.Foil("silicon", 1.0)
        >>> round(float(foil.range("alpha", 5.486e6, lowest_energy=1e3)))
        31
        """
        return self._losses(ion, energy, positive("lowest_energy", lowest_energy)) / 1e4

    def _losses(self, ion: Ion | IonName, energy: ArrayLike, lowest: float | None) -> NDArray[np.float64]:
        given = ion_of(ion)
        energies = positive_array("energy", energy)
        found = _core.foil_stopping(
            foil=self._described(given),
            ion=(given.atomic_number, given.mass),
            energy=energies.ravel(),
            lowest=lowest,
        )
        return found.reshape(energies.shape)[()]

    def _hit(
        self,
        ion: Ion | IonName,
        beam_energy: object,
        lowest_energy: object,
        incidence: object,
        collisions: object,
        forced_angle: object,
    ) -> Bombardment:
        energy = number("beam_energy", beam_energy)
        lowest = energy * 1e-3 if lowest_energy is None else number("lowest_energy", lowest_energy)
        kind = one_of("collisions", collisions, ("multiple", "single"))
        forced = None if forced_angle is None else number("forced_angle", forced_angle)
        return Bombardment(self, ion_of(ion), energy, lowest, number("incidence", incidence), kind, forced)
