"""How one rigid body of a run turns: what is conserved, and pictures of it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from visviva._html import Sheet, Shown, briefly
from visviva._keywords import frozen, known_keywords
from visviva._made_by import made_by
from visviva.errors import InvalidInput
from visviva.rigid._orientation import quaternion_product, rotate_back
from visviva.rigid._rotation import Rotation

if TYPE_CHECKING:
    from os import PathLike

    from matplotlib.animation import FuncAnimation
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    from visviva.body import BodyMotion

__all__ = ["BodyTurning"]


@known_keywords
@frozen
class BodyTurning(Rotation, Shown):
    """How a rigid body turns along a run. Made by ``out["name"].turning``.

    Units: those of the scene; angles in radians.

    Attributes
    ----------
    t : ndarray, shape (T,)
    moments : ndarray, shape (3,)
        Principal moments about the center of mass, or about the point that is held; axes are the principal ones here.
    orientation : ndarray, shape (T, 4)
        Quaternions (x, y, z, w) from the principal axes to space.
    angular_velocity : ndarray, shape (T, 3)
        Along the principal axes.
    body_angular_momentum : ndarray, shape (T, 3)
        Likewise, about the center of mass or the point that is held.
    angular_momentum : ndarray, shape (T, 3)
        The same in space.
    energy : ndarray, shape (T,)
        ½ ω·I ω.
    casimir : ndarray, shape (T,)
        L·L, which no torque-free motion changes, whatever the moments.

    References
    ----------
    H. Goldstein, C. Poole & J. Safko, *Classical Mechanics*, 3rd ed., § 5.6.

    Examples
    --------
    >>> import numpy as np, visviva as vv
    >>> book = vv.RigidBody(1.0, [1.0, 2.0, 2.5], angular_velocity=[1e-3, 1.0, 1e-3], name="book")
    >>> turning = vv.Scene(book).run(t=np.linspace(0.0, 50.0, 501))["book"].turning
    >>> bool(np.ptp(turning.casimir) < 1e-14), turning.plot("polhode").axes[0].get_title()
    (True, 'polhode')
    """

    __slots__ = ("_motion", "angular_velocity", "body_angular_momentum", "moments", "orientation", "t")

    t: NDArray[np.float64]
    moments: NDArray[np.float64]
    orientation: NDArray[np.float64]
    angular_velocity: NDArray[np.float64]
    body_angular_momentum: NDArray[np.float64]
    _motion: BodyMotion

    def __init__(self, motion: BodyMotion) -> None:
        from visviva.body import BodyMotion

        made_by(self, "out.body(name).turning of a run", motion=(motion, BodyMotion))
        run = motion._run
        if run._start._is_ensemble:
            raise InvalidInput("turning", "expected the run of one member: out[i] of an ensemble has them")
        rigid = run._scene.rigid_bodies
        place = motion.index - len(run._scene.particles) + (0 if rigid is None else len(rigid))
        if rigid is None or place < 0:
            raise InvalidInput("body", f"expected a rigid body, but {motion.name} is a particle")
        axes = rigid.axes[place]
        spin = rotate_back(axes, run.angular_velocity[:, place])
        values = {
            "_motion": motion,
            "t": motion.t,
            "moments": rigid.principal_moments[place],
            "orientation": quaternion_product(run.orientation[:, place], axes),
            "angular_velocity": spin,
            "body_angular_momentum": rigid.principal_moments[place] * spin,
        }
        for name, value in values.items():
            if isinstance(value, np.ndarray):
                value.setflags(write=False)
            object.__setattr__(self, name, value)

    def __repr__(self) -> str:
        return f"BodyTurning({self._motion.name!r}, {len(self.t)} times)"

    def _sheet(self) -> Sheet:
        span = f", {self.t[0]:g} to {self.t[-1]:g}" if len(self.t) else ""
        columns = ("moments", "orientation", "angular_velocity", "body_angular_momentum")
        rows = [("times", f"{len(self.t)}{span}"), *((name, briefly(getattr(self, name))) for name in columns)]
        return Sheet(f"Turning of {self._motion.name}", rows)

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self._motion,)

    def plot(
        self, kind: Literal["polhode", "herpolhode", "axes", "components"] = "polhode", *, ax: Axes | None = None
    ) -> Figure:
        """Draw how the body turns, as `visviva.rigid.FreeRotation.plot` does.

        Parameters
        ----------
        kind : {"polhode", "herpolhode", "axes", "components"}
            The path of the angular velocity on the inertia ellipsoid, or on the plane across the angular momentum at
            the start; where the body's three axes point in space (the nutation of a top is that of its axis); or the
            angular velocity along them against time.
        ax : matplotlib.axes.Axes, optional
            Where, of three dimensions where the picture has them; a figure of its own if not given.

        Returns
        -------
        matplotlib.figure.Figure
            The figure that holds the picture; pyplot does not know it.

        Raises
        ------
        visviva.InvalidInput
            For another kind, an ``ax`` of another dimension, or a motion that has no such picture: a single time, a
            rod, a body at rest.

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> out = vv.Scene(vv.RigidBody(1.0, [1.0, 2.0, 2.5], angular_velocity=[0.1, 1.0, 0])).run(t=np.arange(9.0))
        >>> out.body(0).turning.plot("axes").axes[0].get_title()
        "the body's axes in space"
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
        >>> book = vv.RigidBody(1.0, [1.0, 2.0, 2.5], angular_velocity=[0.1, 1.0, 0])
        >>> out = vv.Scene(book).run(t=np.linspace(0.0, 20.0, 51)).body(0).turning
        >>> len(list(out.animate().new_frame_seq()))
        51
        """
        from visviva._boxes import animate_turning

        return animate_turning(self, path, plane, {"trail": trail, "frames": frames, "fps": fps})


def __dir__() -> list[str]:
    return list(__all__)
