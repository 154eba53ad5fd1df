"""What follows from how a body turns, whoever found it: by the exact solution, or along a run."""

from __future__ import annotations

from typing import TYPE_CHECKING

from visviva.rigid._orientation import rotate

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


class Rotation:
    """The angular momentum in space, the energy and the Casimir function of a body along its principal axes."""

    __slots__ = ()

    orientation: NDArray[np.float64]
    angular_velocity: NDArray[np.float64]
    body_angular_momentum: NDArray[np.float64]

    @property
    def angular_momentum(self) -> NDArray[np.float64]:
        """The angular momentum in space, (T, 3): where nothing turns the body, always the same but for rounding."""
        return rotate(self.orientation, self.body_angular_momentum)

    @property
    def energy(self) -> NDArray[np.float64]:
        """The kinetic energy ½ ω·I ω, (T,): where nothing turns the body, always the same but for rounding."""
        value: NDArray[np.float64] = 0.5 * (self.body_angular_momentum * self.angular_velocity).sum(axis=-1)
        return value

    @property
    def casimir(self) -> NDArray[np.float64]:
        """L·L of the angular momentum in the body, (T,), a Casimir function: no moments matter to it."""
        value: NDArray[np.float64] = (self.body_angular_momentum**2).sum(axis=-1)
        return value
