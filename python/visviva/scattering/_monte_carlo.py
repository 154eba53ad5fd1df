"""The scattering Monte Carlo: what is asked for, checked, and counted by the core."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Set
from typing import TYPE_CHECKING, Any

import numpy as np

from visviva import _core
from visviva._arrays import float_array, number, whole_number
from visviva._keywords import known_keywords
from visviva._progress import callback
from visviva.errors import Interrupted, InvalidInput
from visviva.potentials import Coulomb
from visviva.scattering._tally import Beam, MonteCarlo, Tally

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from visviva._progress import Progress
    from visviva.potentials import Potential

__all__ = ["monte_carlo"]


@known_keywords
def monte_carlo(
    potential: Potential,
    *,
    beam_energy: float,
    masses: tuple[float, float],
    b_max: float,
    n_events: int,
    seed: int,
    tally: str | Iterable[str] | Mapping[str, int | ArrayLike] = "cm_angle",
    bins: int = 180,
    threads: int | None = None,
    first_event: int = 0,
    progress: Progress = False,
) -> MonteCarlo:
    """Scatter a parallel beam off one centre and count every event.

    The impact parameter is uniform over a disc: b² uniform in [0, b_max²). Event i takes its random number from
    Philox 4x32-10 with ``seed`` as the key and i as the counter, so the counts do not depend on threads, processor or
    partition, and results of separate ranges of events add up to that of the whole.

    Parameters
    ----------
    potential : Coulomb
        V = k/r, k of either sign but not 0.
    beam_energy : float
        Energy of the projectile in the laboratory; the target is at rest.
    masses : tuple of float
        Projectile and target.
    b_max : float
        Radius of the disc. The smallest deflection, ``result.smallest_angle``, is 2 atan(|k| / (2 E b_max)),
        E = beam_energy · m₂/(m₁ + m₂): bins below it are not reached, see `Tally.reachable`.
    n_events : int
        At least 1.
    seed : int
        0 to 2⁶⁴ − 1.
    tally : str, iterable of str, or mapping
        What to count: ``"cm_angle"`` (size of the deflection in the centre-of-mass frame), ``"lab_angle"``,
        ``"recoil_angle"``, ``"energy"``, ``"recoil_energy"``, ``"impact_parameter"``; one name, several, or
        ``{name: edges}``, where a whole number in place of edges is a number of equal bins. Angles are in radians.
    bins : int
        Number of equal bins, over all possible values, of each tally that is given by its name only; up to 65536.
    threads : int, optional
        By default ``VISVIVA_THREADS``, else all cores.
    first_event : int
        Index of the first event.
    progress : bool or callable
        True for a bar, or ``f(done, total)``.

    Returns
    -------
    MonteCarlo
        ``result["cm_angle"].counts``, ``.edges``, ``.values()``, ``.variances()``, ``.cross_section()``.

    Raises
    ------
    InvalidInput
        For any argument out of range, by name; edges outside the range of their quantity too.
    Interrupted
        After Ctrl-C, or if ``progress`` raises `KeyboardInterrupt`. Its ``.result`` holds the events counted until
        then, from ``first_event`` without a gap (None if there are none yet): with a run of the rest, from
        ``.result.next_event`` on, it adds up to the whole, bit for bit.

    References
    ----------
    J. K. Salmon et al., *Parallel random numbers: as easy as 1, 2, 3*, SC'11 (2011).

    Examples
    --------
    >>> import visviva as vv
    >>> beam = dict(beam_energy=1.0, masses=(1.0, 4.0), b_max=2.0, seed=1)
    >>> whole = vv.scattering.monte_carlo(vv.potentials.Coulomb(1.0), n_events=1000, **beam)
    >>> part = vv.scattering.monte_carlo(vv.potentials.Coulomb(1.0), n_events=600, **beam)
    >>> rest = vv.scattering.monte_carlo(vv.potentials.Coulomb(1.0), n_events=400, first_event=600, **beam)
    >>> bool(((part + rest)["cm_angle"].counts == whole["cm_angle"].counts).all())
    True
    """
    if not isinstance(potential, Coulomb):
        raise InvalidInput("potential", f"expected a Coulomb potential, got {potential!r}")
    pair = float_array("masses", masses, (2,))
    first = whole_number("first_event", first_event, 0, 2**63 - 1)
    count = whole_number("n_events", n_events, 1, 2**63 - first)
    key = whole_number("seed", seed, 0, 2**64 - 1)
    request: dict[str, Any] = {
        "k": potential.k,
        "beam_energy": number("beam_energy", beam_energy),
        "masses": (float(pair[0]), float(pair[1])),
        "b_max": number("b_max", b_max),
        "tallies": _tallies(tally, whole_number("bins", bins, 1, 2**16)),
        "threads": None if threads is None else whole_number("threads", threads, 1, 1024),
    }
    with callback(progress) as report:
        counted, interrupted, smallest, columns = _core.monte_carlo(
            **request, n_events=count, seed=key, first_event=first, progress=report
        )
    beam = Beam(potential, request["beam_energy"], request["masses"], request["b_max"], smallest)
    events = ((key, first, first + counted),)
    result = MonteCarlo(beam, events, tuple(Tally(*column, beam, events) for column in columns))
    if interrupted:
        raise Interrupted(f"interrupted after {counted} of {count} events", result=result)
    return result


def _tallies(tally: object, bins: int) -> list[tuple[str, int | NDArray[np.float64]]]:
    if isinstance(tally, str):
        tally = (tally,)
    pairs: list[tuple[str, int | NDArray[np.float64]]]
    if isinstance(tally, Mapping):
        pairs = [(name, _edges_or_bins(str(name), given)) for name, given in tally.items()]
    elif isinstance(tally, Iterable):
        # A set has no order of its own that would be the same in the next process.
        pairs = [(name, bins) for name in (sorted(tally, key=str) if isinstance(tally, Set) else tally)]
    else:
        raise InvalidInput("tally", f"expected a name, several names or a mapping to edges, got {tally!r}")
    names = [name for name, _ in pairs]
    if not names or not all(isinstance(name, str) for name in names) or len(set(names)) < len(names):
        raise InvalidInput("tally", f"expected one or more different names, got {names!r}")
    # Half a surrogate pair is no text to the core; what remains is refused there as an unknown name.
    return [(name.encode(errors="replace").decode(), edges) for name, edges in pairs]


def _edges_or_bins(name: str, given: Any) -> int | NDArray[np.float64]:
    if isinstance(given, int | np.integer) and not isinstance(given, bool):
        return whole_number(name, given, 1, 2**16)
    if np.ndim(given) == 0:
        raise InvalidInput(name, f"expected edges or a number of bins, got {given!r}; pass a list of edges, or an int")
    return float_array(name, given, (None,))
