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
        """The angular momentum in space, shape (T, 3), in the units of the scene.

        Where nothing turns the body, always the same but for rounding.

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> book = vv.RigidBody(1.0, [1.0, 2.0, 2.5], angular_velocity=[0.1, 1.0, 0.0], name="book")
        >>> out = vv.Scene(book).run(t=np.linspace(0.0, 5.0, 6))
        >>> out["book"].turning.angular_momentum.shape
        (6, 3)
        """
        return rotate(self.orientation, self.body_angular_momentum)

    @property
    def energy(self) -> NDArray[np.float64]:
        """The kinetic energy ½ ω·I ω, shape (T,), in the units of the scene.

        Where nothing turns the body, always the same but for rounding.

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> book = vv.RigidBody(1.0, [1.0, 2.0, 2.5], angular_velocity=[0.1, 1.0, 0.0], name="book")
        >>> out = vv.Scene(book).run(t=np.linspace(0.0, 5.0, 6))
        >>> out["book"].turning.energy.round(12)
        array([1.005, 1.005, 1.005, 1.005, 1.005, 1.005])
        """
        value: NDArray[np.float64] = 0.5 * (self.body_angular_momentum * self.angular_velocity).sum(axis=-1)
        return value

    @property
    def casimir(self) -> NDArray[np.float64]:
        """L·L of the angular momentum in the body, shape (T,), in the units of the scene.

        A Casimir function: no moments matter to it.

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> book = vv.RigidBody(1.0, [1.0, 2.0, 2.5], angular_velocity=[0.1, 1.0, 0.0], name="book")
        >>> out = vv.Scene(book).run(t=np.linspace(0.0, 5.0, 6))
        >>> out["book"].turning.casimir.round(12)
        array([4.01, 4.01, 4.01, 4.01, 4.01, 4.01])
        """
        value: NDArray[np.float64] = (self.body_angular_momentum**2).sum(axis=-1)
        return value
