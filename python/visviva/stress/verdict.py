"""What a method makes of a case: an answer with its errors, a named refusal or ending, or a failure.

The one idea: a wrong number is a failure only if it is told as a right one. Whoever chooses a step chooses its error:
of methods with fixed steps a large error must come with a warning; one that chooses its steps must hold its tolerance
in each, times what the motion amplifies, or end by name.
"""

from __future__ import annotations

import time
import warnings
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from visviva._html import Record
from visviva._keywords import known_keywords
from visviva.errors import AccuracyWarning, Error, InvalidInput
from visviva.status import Status

if TYPE_CHECKING:
    from visviva.integrators import Method
    from visviva.scene import Scene
    from visviva.stress.cases import Case

__all__ = ["Verdict", "judged"]

_RTOL = 1e-12
_NOTICED = 2e-2
"""Of kinetic + |potential| energy: beyond it a run warns (see `visviva.AccuracyWarning`), from 1e-2 on."""
_LONGEST = 30.0
"""Seconds, for cases of the short form: a hang."""


@known_keywords
@dataclass(frozen=True, slots=True, repr=False)
class Verdict(Record):
    """What a method made of a case.

    Attributes
    ----------
    case, method : str
    word : str
        ``"ok"``, ``"warned"``, ``"ended"``, ``"refused"`` or ``"FAILED"``.
    told : str
        The refusal, the ending, or what is wrong.
    position_error, energy_error : float
        Relative to the size of the motion and of the energies, without dimension; NaN where they are not known.
    seconds : float
        What it took, in seconds.

    Examples
    --------
    >>> import visviva as vv
    >>> verdict = vv.stress.run(["dop853"], cases=["two bodies in one place"]).verdicts[0]
    >>> verdict.method, verdict.word
    ('dop853', 'refused')
    """

    case: str
    method: str
    word: str
    told: str
    position_error: float
    energy_error: float
    seconds: float


def judged(case: Case, method: Method) -> Verdict:
    """Run a case by a method."""
    began = time.perf_counter()

    def verdict(word: str, told: str, position: float = np.nan, energy: float = np.nan) -> Verdict:
        return Verdict(case.name, method.name, word, told, position, energy, time.perf_counter() - began)

    how: dict[str, Any] = {"rtol": _RTOL} if method.adaptive else {"dt": case.span / case.steps}
    if case.most is not None:
        how["max_steps"] = case.most
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            scene = case.make()
            out = scene.run(t=case.span, method=method.name, **how)
        except InvalidInput as error:
            return verdict("refused", f"{error.argument}: {error}")
        except Error as error:
            partial = getattr(error, "trajectory", None)
            if partial is not None and not _finite(partial.final):
                return verdict("FAILED", f"{type(error).__name__}, and the state it kept is not finite")
            return verdict("ended", f"{type(error).__name__}: {error}")
        except Exception as error:  # what must not happen is told, not raised
            return verdict("FAILED", f"{type(error).__name__}: {error}")
    seconds = time.perf_counter() - began
    warned = any(issubclass(one.category, AccuracyWarning) for one in caught)
    other = [str(one.message) for one in caught if not issubclass(one.category, AccuracyWarning)]
    if other:
        return verdict("FAILED", f"a warning of something else: {other[0]}")
    if not _finite(out.final):
        return verdict("FAILED", "not finite, with status OK")
    if seconds > _LONGEST and not case.long:
        return verdict("FAILED", f"took {seconds:.0f} s")
    position, energy = _position_error(case, scene, out.final), _energy_error(scene, out.final)
    if out.status is not Status.OK:
        return verdict("ended", out.status.name, position, energy)
    if warned:
        return verdict("warned", "", position, energy)
    if energy > _NOTICED:
        return verdict("FAILED", f"the energy is off by {energy:.1g} without a word", position, energy)
    if method.adaptive and position > case.amplifies * _RTOL * max(out.stats.steps, 1):
        return verdict("FAILED", f"off by {position:.1g} without a word", position, energy)
    return verdict("ok", "", position, energy)


def _finite(scene: Scene) -> bool:
    return bool(np.isfinite(scene.particles.position).all() and np.isfinite(scene.particles.velocity).all())


def _position_error(case: Case, start: Scene, final: Scene) -> float:
    """Against the closed form, relative to the size of the motion."""
    if not case.closed:
        return float("nan")
    times = start.t0 + (final.t0 - start.t0) * np.array([0.25, 0.5, 0.75, 1.0])
    exact = start.run(t=times).position
    moved = float(np.abs(exact - start.particles.position).max())
    off = float(np.abs(final.particles.position - exact[-1]).max())
    return off / moved if moved > 0.0 else off


def _energy_error(start: Scene, final: Scene) -> float:
    """Relative to the kinetic and the potential energies of both ends, where the forces keep it."""
    out = final.invariants(), start.invariants()
    energies = [invariants.energy for invariants in out]
    if not np.isfinite(energies).all() or not _keeps_energy(start):
        return float("nan")
    kinetic = [0.5 * (scene.particles.mass[:, None] * scene.particles.velocity**2).sum() for scene in (final, start)]
    scale = max(k + abs(e - k) for k, e in zip(kinetic, energies, strict=True))
    return float(abs(energies[0] - energies[1]) / scale) if scale > 0.0 else 0.0


def _keeps_energy(scene: Scene) -> bool:
    from visviva.invariants import kept_by_forces

    return bool(kept_by_forces(scene, np.zeros(3))["energy"])


def __dir__() -> list[str]:
    return list(__all__)
