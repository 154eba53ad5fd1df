"""What is told of all bodies together: energies, the virial, momenta and the center of mass.

The one idea: none of them has to be recorded. Each follows from the states of all bodies on first use, and is a column
like any other, which `_column` finds.
"""

from __future__ import annotations

from abc import abstractmethod
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

__all__ = ["Totals"]


class Totals:
    """Base of what has the columns that are sums over all bodies."""

    __slots__ = ()

    @abstractmethod
    def _column(self, name: str) -> NDArray[np.float64]:
        """The column, recorded or computed."""

    @property
    def energy(self) -> NDArray[np.float64]:
        """Total energy, shape (T,), or (B, T), in the units of the scene.

        Examples
        --------
        >>> import visviva as vv
        >>> out = vv.problems.kepler(e=0.5).scene.run(t=[0.0, 1.0])
        >>> out.energy.round(12)
        array([-0.125, -0.125])
        """
        return self._column("energy")

    @property
    def kinetic_energy(self) -> NDArray[np.float64]:
        """Kinetic energy, shape (T,), or (B, T), in the units of the scene.

        Examples
        --------
        >>> import visviva as vv
        >>> out = vv.problems.kepler(e=0.5).scene.run(t=[0.0, 1.0])
        >>> out.kinetic_energy.round(12)
        array([0.375     , 0.13434051])
        """
        return self._column("kinetic_energy")

    @property
    def potential_energy(self) -> NDArray[np.float64]:
        """Potential energy of all forces, shape (T,), or (B, T), in the units of the scene.

        Examples
        --------
        >>> import visviva as vv
        >>> out = vv.problems.kepler(e=0.5).scene.run(t=[0.0, 1.0])
        >>> out.potential_energy.round(12)
        array([-0.5       , -0.25934051])
        """
        return self._column("potential_energy")

    @property
    def virial(self) -> NDArray[np.float64]:
        """The virial Σ r·F, shape (T,), or (B, T), an energy in the units of the scene.

        NaN beside forces that look at velocities or times (drag, magnetic fields, drives): it is that of potentials.

        Examples
        --------
        >>> import visviva as vv
        >>> out = vv.problems.kepler(e=0.5).scene.run(t=[0.0, 1.0])
        >>> out.virial.round(12)  # of gravity the potential energy
        array([-0.5       , -0.25934051])
        """
        return self._column("virial")

    @property
    def momentum(self) -> NDArray[np.float64]:
        """Total momentum, shape (T, 3), or (B, T, 3), in the units of the scene.

        Examples
        --------
        >>> import visviva as vv
        >>> out = vv.problems.kepler(e=0.5).scene.run(t=[0.0, 1.0])
        >>> out.momentum.round(12) + 0.0
        array([[0., 0., 0.],
               [0., 0., 0.]])
        """
        return self._column("momentum")

    @property
    def angular_momentum(self) -> NDArray[np.float64]:
        """Total angular momentum about the origin, shape (T, 3), or (B, T, 3), in the units of the scene.

        Examples
        --------
        >>> import visviva as vv
        >>> out = vv.problems.kepler(e=0.5).scene.run(t=[0.0, 1.0])
        >>> out.angular_momentum.round(12) + 0.0
        array([[0.        , 0.        , 0.21650635],
               [0.        , 0.        , 0.21650635]])
        """
        return self._column("angular_momentum")

    @property
    def center_of_mass(self) -> NDArray[np.float64]:
        """Center of mass, shape (T, 3), or (B, T, 3), in the units of the scene.

        Examples
        --------
        >>> import visviva as vv
        >>> out = vv.problems.kepler(e=0.5).scene.run(t=[0.0, 1.0])
        >>> out.center_of_mass.round(12) + 0.0
        array([[0., 0., 0.],
               [0., 0., 0.]])
        """
        return self._column("center_of_mass")
