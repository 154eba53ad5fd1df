"""Channels of a Monte Carlo: what becomes of projectile and target, and what energy that releases or takes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from visviva._arrays import float_array, number
from visviva._html import Record
from visviva._keywords import known_keywords
from visviva.errors import InvalidInput

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import ArrayLike

__all__ = ["Channel", "as_channels"]


@known_keywords
@dataclass(frozen=True, repr=False)
class Channel(Record):
    """A reaction that events of a Monte Carlo go through with some probability.

    The bodies leave by the angle ψ to which the potential deflects them, in the frame in which their momenta cancel,
    with the speeds that the laboratory's balance leaves them: T₃ + T₄ = E + Q, and the momentum m₁v of the beam. So the
    energy of their relative motion is ½μ'w'² = E + Q − E m₁/(m₃ + m₄). Of products that sum to m₁ + m₂ that is
    ½μw² + Q; of others it is not, as their center of mass moves at m₁v/(m₃ + m₄), no longer at m₁v/(m₁ + m₂).

    Units: energies in those of the beam, masses in those of its masses; probabilities are without dimension.

    Parameters
    ----------
    q_value : float
        Energy that is released (Q > 0) or taken up (Q < 0), in the unit of `beam_energy`.
    probability : float or pair of array_like, shape (P,)
        The part of all events, in [0, 1]; or (impact parameters, the part at each), linear between them and beyond the
        ends as at the ends. What all channels of a run leave of 1 is scattered elastically. Of parts that differ with
        the impact parameter `Tally.expected` knows ``cm_angle`` and ``impact_parameter`` only.
    products : tuple of float, optional
        Masses of what projectile and target become, in the unit of `masses`; by default they stay what they are.
    excitation_function : pair of array_like, shape (P,), optional
        (Energies of the projectile in the laboratory, the factor at each), in [0, 1], linear between them and beyond
        the ends as at the ends: `probability` is multiplied by it. A beam may come below the threshold of a channel
        where the factor is 0. Of such a channel and an energy spread `Tally.expected` knows ``impact_parameter`` only.

    Raises
    ------
    InvalidInput
        For a Q that is no number, a part outside [0, 1], masses that are not positive, or a table with fewer than two
        rows or whose first column does not rise from 0 or more.

    References
    ----------
    R. D. Evans, *The Atomic Nucleus* (1955), ch. 12 §2.

    Examples
    --------
    A tenth of all events excites the target by 1.5, which takes at least 1.5 (m₁ + m₂)/m₂ = 1.875:

    >>> import visviva as vv
    >>> excited = vv.scattering.Channel(q_value=-1.5, probability=0.1)
    >>> beam = dict(masses=(1.0, 4.0), b_max=1.0, n_events=1000, seed=1)
    >>> events = vv.scattering.scattering_events(
    ...     vv.potentials.HardSphere(1.0), beam_energy=5.0, channels=[excited], **beam)
    >>> after = events["energy"] + events["recoil_energy"]
    >>> sorted({(int(channel), round(float(energy), 12)) for channel, energy in zip(events["channel"], after)})
    [(0, 5.0), (1, 3.5)]
    >>> round(float(vv.scattering.threshold_energy(mass_ratio=0.25, q_value=-1.5)), 12)
    1.875

    The same from the threshold on, more and more often, by a beam of two lines of which one is below it:

    >>> rising = vv.scattering.Channel(-1.5, 0.5, excitation_function=([1.875, 10.0], [0.0, 1.0]))
    >>> lines = vv.scattering.Spectrum([1.0, 6.0], [1.0, 1.0])
    >>> events = vv.scattering.scattering_events(
    ...     vv.potentials.HardSphere(1.0), beam_energy=lines, channels=[rising], **beam)
    >>> excited = events["channel"] == 1
    >>> {float(energy) for energy in events["beam_energy"][excited]}
    {6.0}
    """

    q_value: float
    probability: float | tuple[tuple[float, ...], tuple[float, ...]]
    products: tuple[float, float] | None = None
    excitation_function: tuple[tuple[float, ...], tuple[float, ...]] | None = None

    def __init__(
        self,
        q_value: float,
        probability: float | tuple[ArrayLike, ArrayLike],
        products: ArrayLike | None = None,
        excitation_function: tuple[ArrayLike, ArrayLike] | None = None,
    ) -> None:
        masses = table = None
        released, part = number("q_value", q_value), _probability(probability)
        if products is not None:
            pair = float_array("products", products, (2,))
            if not (pair > 0.0).all():
                raise InvalidInput("products", f"expected two positive masses, got {pair.tolist()}")
            masses = (float(pair[0]), float(pair[1]))
        if excitation_function is not None:
            table = _table("excitation_function", "energies", excitation_function)
        kept = {"q_value": released, "probability": part, "products": masses, "excitation_function": table}
        for name, value in kept.items():
            object.__setattr__(self, name, value)


def _probability(given: object) -> float | tuple[tuple[float, ...], tuple[float, ...]]:
    if not isinstance(given, (tuple, list)):
        part = number("probability", given)
        if not 0.0 <= part <= 1.0:
            raise InvalidInput("probability", f"expected a part of all events, in [0, 1], got {part}")
        return part
    return _table("probability", "impact parameters", given)


def _table(name: str, arguments: str, given: object) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Arguments that rise from 0 or more, and a part in [0, 1] for each."""
    if not isinstance(given, (tuple, list)) or len(given) != 2:
        raise InvalidInput(name, f"expected {arguments} and the part at each, two arrays, got {given!r}")
    places, parts = (float_array(name, values, (None,)) for values in given)
    if len(places) != len(parts) or len(places) < 2:
        raise InvalidInput(
            name, f"expected 2 or more {arguments} and a part for each, got {len(places)} and {len(parts)}"
        )
    if not (places[0] >= 0.0 and (places[1:] > places[:-1]).all()):
        raise InvalidInput(name, f"expected {arguments} that rise from 0 or more, got {places.tolist()}")
    if not ((parts >= 0.0) & (parts <= 1.0)).all():
        raise InvalidInput(name, f"expected parts of all events, in [0, 1], got {parts.tolist()}")
    return tuple(places.tolist()), tuple(parts.tolist())


def as_channels(given: Channel | Iterable[Channel] | None) -> tuple[Channel, ...]:
    """Channels as an argument: one or several."""
    if given is None:
        return ()
    try:
        channels = (given,) if isinstance(given, Channel) else tuple(given)
    except TypeError:
        raise InvalidInput("channels", f"expected Channel or several of them, got {given!r}") from None
    for channel in channels:
        if not isinstance(channel, Channel):
            raise InvalidInput("channels", f"expected Channel or several of them, one is {channel!r}")
    return channels
