"""What a scene is asked by where its motion begins and ends.

The one idea: a scene knows nothing of the search, which is `_between_places`, until somebody asks for it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

from visviva._keywords import known_keywords
from visviva.request import BoundaryRequest, asked_by

if TYPE_CHECKING:
    from visviva.scene import Scene

__all__ = ["BetweenPlaces"]


@known_keywords
class BetweenPlaces:
    """A base of `Scene`: motions that are asked for by where they begin and end."""

    __slots__ = ()

    @asked_by(BoundaryRequest)
    def boundary_value(self, request: BoundaryRequest) -> Scene:
        """The scene with the velocities at the start that lead bodies to places at a time, as of Lambert's problem.

        There may be several: a planet may go round either way, once or often. What is given is the motion that Newton's
        method comes to from the present velocities, as of a Lagrangian (`Lagrangian.boundary_value`).

        Units: those of the scene.

        Parameters
        ----------
        t : float
            The time of arrival.
        position : array_like, shape (3,) or (K, 3)
            The places of one body or of several.
        body : int, str or sequence of them, optional
            Which bodies have other velocities and arrive there; all if not given.
        method, dt, rtol, threads : optional
            As of `run`, and of `flow_jacobian`; `rtol` is 1e-12 if neither it nor `dt` is given.

        Returns
        -------
        Scene
            This one, with other velocities.

        Raises
        ------
        visviva.InvalidInput
            As `run` and `flow_jacobian`; rigid bodies; the time of the start.
        visviva.ConvergenceError
            If no such motion is found; the message tells how near the nearest came, and whether the places are
            conjugate to each other.

        References
        ----------
        W. H. Press, S. A. Teukolsky, W. T. Vetterling & B. P. Flannery, *Numerical Recipes*, 3rd ed. (2007), § 18.1.

        Examples
        --------
        From the Earth's orbit to that of Mars in 0.7 years:

        >>> import numpy as np, visviva as vv
        >>> sun = vv.CentralField(vv.potentials.PowerLaw(k=-4.0 * np.pi**2, n=1.0))
        >>> probe = vv.Scene(vv.Particles([1.0], [[1.0, 0.0, 0.0]], [[0.0, 7.0, 0.0]]), sun)
        >>> thrown = probe.boundary_value(0.7, [-1.5, 0.1, 0.05])
        >>> thrown.run(0.7).position[-1, 0].round(9)
        array([-1.5 ,  0.1 ,  0.05])
        """
        from visviva._between_places import boundary_value

        return boundary_value(cast("Scene", self), request)


def __dir__() -> list[str]:
    return list(__all__)
