"""Whether motions are regular or chaotic: the mean exponential growth of nearby orbits (MEGNO).

The one idea: neighbors of a regular motion part in proportion to the time, those of a chaotic one exponentially; an
average over the whole motion, with weights that grow with the time, tells these apart long before an exponent does.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from visviva import _core
from visviva._arrays import whole_number
from visviva._html import Shown
from visviva._keywords import known_keywords
from visviva._sizes_of_motions import looked_at, sizes_of_motions
from visviva._text import short_repr, table
from visviva.errors import ConvergenceError, InvalidInput
from visviva.request import RunRequest
from visviva.status import Status

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from visviva.ensemble import EnsembleScene
    from visviva.request import MegnoRequest
    from visviva.scene import Scene

__all__ = ["Megno"]

#: Instants at which neighbors are looked at, and where among them each is: no motion keeps step with the golden mean.
_INSTANTS = 2048
_GOLDEN = 0.6180339887498949


@known_keywords
@dataclass(frozen=True, slots=True, eq=False)
class Megno(Shown):
    """What neighbors of motions do. Made by `Scene.megno` and `EnsembleScene.megno`.

    Units: times and exponents in those of the scene; the rest are plain numbers.

    Attributes
    ----------
    t : ndarray, shape (T,), or float
        The times, or the end, that was asked for.
    mean_megno : ndarray, shape (B, T), (T,) or (B,), or float
        ⟨Y⟩, the average of Y over the time: it tends to 2 for a regular motion, to 0 for one whose neighbors stay where
        they are (an isochronous one), and grows as λt/2 for a chaotic one.
    megno : ndarray, shape (B, T), (T,) or (B,), or float
        Y = (2/t) ∫ (δ̇/δ) t' dt', of the distance δ of a neighbor: ⟨Y⟩ before it is averaged.
    lyapunov_exponent : ndarray, shape (B, T), (T,) or (B,), or float
        λ = ln(δ(t)/δ(0)) / t: the largest Lyapunov exponent over this time.
    status : ndarray of int8, shape (B,), or int
        How each copy ended, values of `Status`; what comes after is NaN.

    References
    ----------
    P. Cincotta & C. Simó, Astron. Astrophys. Suppl. 147 (2000) 205; K. Goździewski et al., Astron. Astrophys. 378
    (2001) 569.

    Examples
    --------
    >>> import visviva as vv
    >>> found = vv.problems.figure_eight().scene.megno(t=300.0)
    >>> round(found.mean_megno)
    2
    """

    t: NDArray[np.float64] | float
    mean_megno: NDArray[np.float64] | float
    megno: NDArray[np.float64] | float
    lyapunov_exponent: NDArray[np.float64] | float
    status: NDArray[np.int8] | int

    def __repr__(self) -> str:
        return short_repr(self)

    def __str__(self) -> str:
        return table(self)


def megno_of(scene: Scene | EnsembleScene, request: MegnoRequest) -> Megno:
    """Follow each copy and a neighbor to times."""
    from visviva._mergers import hosts, remaining
    from visviva.ensemble import EnsembleScene

    if isinstance(scene, EnsembleScene):
        return _megno(scene, request, scene.run)
    parts = hosts(scene.particles)
    if parts is not None:
        # What has merged is where its host is, and nothing by itself.
        scene = remaining(scene, parts)
    copy = scene.ensemble(position=scene.particles.position[None])
    found = _megno(copy, request, scene.run)
    kinds = (found.mean_megno, found.megno, found.lyapunov_exponent, found.status)
    return Megno(found.t, *(np.asarray(each)[0] for each in kinds))


def _megno(copies: EnsembleScene, request: MegnoRequest, run: Callable[..., Any]) -> Megno:
    """Of copies, or of one scene that is run by itself, which then tells by an error what is wrong with its motion."""
    begin, bodies = copies.scene.t0, len(copies.scene.particles)
    toward = np.random.default_rng(whole_number("seed", request.seed, 0)).normal(size=(bodies, 2, 3))
    threads = None if request.threads is None else whole_number("threads", request.threads)
    how: dict[str, Any] = {"method": request.method, "dt": request.dt, "rtol": request.rtol, "threads": threads}
    asked = RunRequest(t=request.t, **how).to_core(copies._keywords, copies._names)
    times: NDArray[np.float64] = asked["times"]
    if not times.size or times[-1] == begin:
        raise InvalidInput("t", f"expected another time than the start, {begin:g}")
    _core.plan(asked)  # refuses times in another order
    instants = _instants(begin, times, asked["dt"])

    def grown(at: NDArray[np.float64], sizes: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.int8]]:
        followed = cast("_core._Request", {**asked, "end_only": False, "times": at})
        return _core.neighbors(followed, toward, sizes, threads=threads)

    # Nobody goes anywhere from the start to the start, but what cannot be followed is refused.
    grown(np.array([begin]), np.ones((len(copies), 2)))
    motion = looked_at(run, begin, instants, **how)
    logarithm, status = grown(instants, sizes_of_motions(copies, motion))
    if np.ndim(motion.status) == 0 and status[0] != Status.OK:
        last = float(np.append(begin, instants[np.isfinite(logarithm[0])])[-1])
        raise ConvergenceError("the step of a neighbor fell to zero, or it left the range of numbers", last)
    span = np.abs(np.append(begin, instants) - begin)
    logarithm = np.append(np.zeros((len(copies), 1)), logarithm, axis=1)
    megno = 2.0 * (logarithm - _averages(span, logarithm))
    exponents = np.divide(logarithm, span, out=np.zeros_like(logarithm), where=span > 0.0)
    rows: Any = np.searchsorted(span, np.abs(times - begin))
    told: Any = times
    if asked["end_only"]:
        told, rows = float(times[-1]), rows[-1]
    ended = np.where(np.asarray(motion.status) == Status.OK, status, motion.status).astype(np.int8)
    return Megno(told, _averages(span, megno)[:, rows], megno[:, rows], exponents[:, rows], ended)


def _instants(begin: float, asked: NDArray[np.float64], dt: float | None) -> NDArray[np.float64]:
    """Instants at which neighbors are looked at, in the order of the motion, at the ends of steps that are equal."""
    places = (np.arange(_INSTANTS) + np.arange(_INSTANTS) * _GOLDEN % 1.0) / _INSTANTS
    since = places * abs(asked[-1] - begin)
    if dt is not None:
        since = np.rint(since / abs(dt)) * abs(dt)
    since = since[(since > 0.0) & (since < abs(asked[-1] - begin))]
    forward = asked[-1] > begin
    times = np.unique(np.concatenate([asked[asked != begin], begin + (since if forward else -since)]))
    return times if forward else times[::-1]


def _averages(span: NDArray[np.float64], values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Of values (B, T) over the time from the start to each."""
    areas = 0.5 * (values[:, 1:] + values[:, :-1]) * np.diff(span)
    return np.concatenate([values[:, :1], np.cumsum(areas, axis=1) / span[1:]], axis=1)


def __dir__() -> list[str]:
    return list(__all__)
