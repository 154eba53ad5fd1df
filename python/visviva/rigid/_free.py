"""A body that nothing turns, at any time."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from visviva import _core
from visviva._arrays import float_array
from visviva._html import Record
from visviva._keywords import known_keywords
from visviva.rigid._arguments import checked_rows
from visviva.rigid._rotation import Rotation

if TYPE_CHECKING:
    from os import PathLike

    from matplotlib.animation import FuncAnimation
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import ArrayLike, NDArray


@known_keywords
@dataclass(frozen=True, eq=False, kw_only=True, slots=True, repr=False)
class FreeRotation(Rotation, Record):
    """The states of a free rotation; what :func:`free_rotation` returns.

    Of a single time, arrays have no axis over the times. All are read-only.

    Units: those of the caller, one consistent system; angles in radians.

    Attributes
    ----------
    t : ndarray, shape (T,)
        The times, as given.
    moments : ndarray, shape (3,)
        The principal moments, as given.
    angular_velocity : ndarray, shape (T, 3)
        Along the body's principal axes.
    orientation : ndarray, shape (T, 4)
        Quaternions (x, y, z, w), from the body to space; |q| is 1 to 4 ε.
    body_angular_momentum : ndarray, shape (T, 3)
        Along the body's principal axes.

    References
    ----------
    Jacobi, J. reine angew. Math. 39 (1850) 293; Landau & Lifshitz, *Mechanics*, 3rd ed., § 37.

    Examples
    --------
    >>> import numpy as np, visviva as vv
    >>> turning = vv.rigid.free_rotation([1.0, 2.0, 3.0], [0.1, 1.0, 0.1], np.linspace(0.0, 20.0, 201))
    >>> turning.orientation.shape, bool(np.ptp(turning.energy) < 1e-14)
    ((201, 4), True)
    """

    t: NDArray[np.float64]
    moments: NDArray[np.float64]
    angular_velocity: NDArray[np.float64]
    orientation: NDArray[np.float64]
    body_angular_momentum: NDArray[np.float64]

    def plot(
        self, kind: Literal["polhode", "herpolhode", "axes", "components"] = "polhode", *, ax: Axes | None = None
    ) -> Figure:
        """Draw the motion, as a matplotlib Figure.

        Parameters
        ----------
        kind : {"polhode", "herpolhode", "axes", "components"}
            The path of the angular velocity on the inertia ellipsoid Σ I x² = 1 in the body, or on the plane across the
            angular momentum in space (Poinsot); where the body's three axes point in space; or the angular velocity
            along them against time.
        ax : matplotlib.axes.Axes, optional
            Where, of three dimensions where the picture has them; a figure of its own if not given.

        Returns
        -------
        matplotlib.figure.Figure
            With one panel; that of ``ax`` if that is given.

        Raises
        ------
        visviva.InvalidInput
            For another kind, axes of other dimensions, fewer than two times, no matplotlib, a body at rest where a
            direction is asked for, or the inertia ellipsoid of a rod, which has no end.

        Notes
        -----
        Goldstein, Poole & Safko, *Classical Mechanics* 3rd ed. § 5.6.

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> out = vv.rigid.free_rotation([1.0, 2.0, 3.0], [0.1, 1.0, 0.1], np.linspace(0.0, 20.0, 201))
        >>> out.plot("herpolhode").axes[0].get_title()
        'herpolhode'
        """
        from visviva.rigid._pictures import plot_free_rotation

        return plot_free_rotation(self, kind, ax)

    def animate(
        self,
        path: str | PathLike[str] | None = None,
        *,
        plane: Literal["xy", "xz", "yz", "xyz"] | None = None,
        trail: float = 0.1,
        frames: int = 200,
        fps: int = 25,
    ) -> FuncAnimation:
        """Show the body as it turns: its principal axes, and the homogeneous box that has its moments.

        Frames are times of the motion, those nearest to evenly spaced ones: give it as many as should be seen.

        Parameters
        ----------
        path : str or PathLike, optional
            A file ending in ``.gif``, ``.html`` or ``.mp4``, which needs ffmpeg (``pip install 'visviva[video]'``
            brings one); nothing is written without a path.
        plane : str, optional
            What is shown: ``"xy"``, ``"xz"``, ``"yz"``, or ``"xyz"``, the default.
        trail : float
            For how much of the time, from 0 to 1 without dimension, the ways of the axes are shown behind them.
        frames : int
            At most so many.
        fps : int
            Frames a second.

        Returns
        -------
        matplotlib.animation.FuncAnimation
            In a notebook ``IPython.display.HTML(out.animate().to_jshtml())`` shows it.

        Raises
        ------
        visviva.InvalidInput
            If the times are not a row, matplotlib or what writes the file is not installed, or an argument is not one
            of these.

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> out = vv.rigid.free_rotation([1.0, 2.0, 3.0], [0.1, 1.0, 0.1], np.linspace(0.0, 20.0, 51))
        >>> len(list(out.animate().new_frame_seq()))
        51
        """
        from visviva._boxes import animate_turning

        return animate_turning(self, path, plane, {"trail": trail, "frames": frames, "fps": fps})

    def __repr__(self) -> str:
        return f"FreeRotation(t of shape {self.t.shape}, moments={self.moments.tolist()})"


@known_keywords
def free_rotation(
    moments: ArrayLike,
    angular_velocity: ArrayLike,
    t: ArrayLike,
    orientation: ArrayLike | None = None,
) -> FreeRotation:
    """Give the free rotation of a rigid body at any times, in closed form.

    Jacobi's elliptic functions for the angular velocity and theta functions for the orientation: each state costs the
    same, however far it is from the start. Spheres, symmetric bodies, rods, both sides of the separatrix and the
    separatrix itself are all taken as they are.

    Units: those of the caller, one consistent system; angles in radians.

    Parameters
    ----------
    moments : array_like, shape (3,)
        The principal moments of inertia, in any order; one may be 0 (a rod).
    angular_velocity : array_like, shape (3,)
        At time 0, along the body's principal axes.
    t : float or array_like, shape (T,)
        Times since then, of either sign and in any order. Any other shape takes the place of (T,) in all that is given.
    orientation : array_like, shape (4,), optional
        The quaternion (x, y, z, w) from the body to space at time 0; without it, the body's axes are those of space.

    Returns
    -------
    FreeRotation
        With ``.angular_velocity``, ``.orientation``, ``.angular_momentum`` and ``.energy``. Errors are below
        1e-14 + 4 ε φ, relative to the size of each vector, where φ is the angle turned through.

    Raises
    ------
    InvalidInput
        For moments of which one is larger than the other two together (by more than rounding, 1e-12), moments that are
        negative or all zero, spin about the axis of a rod, a quaternion whose length is not 1 within 1e-6, or a time
        until which the turns cannot be counted.

    See Also
    --------
    polhode : what can be said of the motion as a whole: its kind, period and rates.

    Notes
    -----
    Jacobi, J. reine angew. Math. 39 (1850) 293; van Zon & Schofield, J. Comput. Phys. 225 (2007) 145. The complementary
    modulus is formed without a subtraction of rounded numbers, the rates in double-double.

    Examples
    --------
    A tennis racket that is thrown up turning about its middle axis flips over and over:

    >>> import numpy as np, visviva as vv
    >>> out = vv.rigid.free_rotation([1.0, 2.0, 3.0], [1e-4, 1.0, 1e-4], np.linspace(0.0, 80.0, 5))
    >>> out.angular_velocity[:, 1].round(3)
    array([ 1.   , -0.564, -1.   ,  0.997,  1.   ])
    >>> out.angular_momentum[-1].round(12)
    array([1.e-04, 2.e+00, 3.e-04])
    """
    checked = float_array("moments", moments, (3,))
    spin = float_array("angular_velocity", angular_velocity, (3,))
    start = np.array([0.0, 0.0, 0.0, 1.0]) if orientation is None else checked_rows("orientation", orientation, (4,))
    times = float_array("t", t, None)
    found = _core.free_rotation(checked, spin, float_array("orientation", start, (4,)), times.ravel())
    columns = [column.reshape((*times.shape, column.shape[-1])) for column in found]
    velocity, momentum, turns = columns
    kept = (times.copy(), checked.copy())
    for array in (*kept, *columns):
        array.flags.writeable = False
    return FreeRotation(
        t=kept[0], moments=kept[1], angular_velocity=velocity, orientation=turns, body_angular_momentum=momentum
    )
