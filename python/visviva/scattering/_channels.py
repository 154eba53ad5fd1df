"""Channels of a Monte Carlo: what becomes of projectile and target, and what energy that releases or takes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from visviva._arrays import float_array, number
from visviva._keywords import known_keywords
from visviva.errors import InvalidInput

if TYPE_CHECKING:
    from collections.abc import Iterable

__all__ = ["Channel", "as_channels"]


@known_keywords
@dataclass(frozen=True)
class Channel:
    """A reaction that events of a Monte Carlo go through with some probability.

    The bodies leave by the angle ψ to which the potential deflects them, with the speeds in the centre-of-mass frame
    that are left: ½μ'w'² = ½μw² + Q.

    Parameters
    ----------
    q_value : float
        Energy that is released (Q > 0) or taken up (Q < 0), in the unit of `beam_energy`.
    probability : float
        The part of all events, in [0, 1]. What all channels of a run leave of 1 is scattered elastically.
    products : tuple of float, optional
        Masses of what projectile and target become, in the unit of `masses`; by default they stay what they are.

    Raises
    ------
    InvalidInput
        For what are no such numbers.

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
    """

    q_value: float
    probability: float
    products: tuple[float, float] | None = None

    def __post_init__(self) -> None:
        part = number("probability", self.probability)
        if not 0.0 <= part <= 1.0:
            raise InvalidInput("probability", f"expected a part of all events, in [0, 1], got {part}")
        object.__setattr__(self, "q_value", number("q_value", self.q_value))
        object.__setattr__(self, "probability", part)
        if self.products is not None:
            pair = float_array("products", self.products, (2,))
            if not (pair > 0.0).all():
                raise InvalidInput("products", f"expected two positive masses, got {pair.tolist()}")
            object.__setattr__(self, "products", (float(pair[0]), float(pair[1])))


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
