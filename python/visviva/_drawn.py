"""How a trajectory is drawn: its orbits, its columns over time, its phase portrait, and as a moving picture.

The one idea: a run asks for pictures by these methods; the room that makes one is opened when it is asked for.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, cast

from visviva._keywords import known_keywords
from visviva.errors import InvalidInput

if TYPE_CHECKING:
    from os import PathLike

    from matplotlib.animation import FuncAnimation
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from visviva.trajectory import Trajectory
    from visviva.typing import ColumnName

__all__ = ["Drawn"]


@known_keywords
class Drawn:
    """A base of `Trajectory`: its pictures."""

    __slots__ = ()

    def plot(
        self,
        column: ColumnName | None = None,
        *,
        bodies: object = None,
        component: Literal["x", "y", "z", "w"] | None = None,
        plane: Literal["xy", "xz", "yz", "xyz"] | None = None,
        ax: Axes | None = None,
    ) -> Figure:
        """Orbits beside the relative change of the energy, or a column against time, as a matplotlib Figure.

        A change of the energy that is no more than rounding is drawn as points in a band of that name. Where all
        bodies stay on one line along x, y or z, places against time are drawn for orbits, if neither a plane nor axes
        are given; where rigid bodies turn and none goes anywhere, their angular velocities.

        Parameters
        ----------
        column : str, optional
            What is drawn against time, a panel for each component: any that was recorded, or that follows from those.
            Orbits if not given.
        bodies : sequence of int or str, optional
            Which; all if not given. Of a column of the whole scene, none.
        component : {"x", "y", "z", "w"}, optional
            Of a column, one panel; all if not given.
        plane : str, optional
            ``"xy"``, ``"xz"``, ``"yz"``, or ``"xyz"`` for three dimensions. By default the coordinate plane in which
            the orbits extend most, x–y if in doubt.
        ax : matplotlib.axes.Axes, optional
            Where the orbits go, without the energy; of three dimensions for ``"xyz"``. Of a column, where its one panel
            goes.

        Returns
        -------
        matplotlib.figure.Figure
            A new one, or that of `ax`.

        Raises
        ------
        visviva.InvalidInput
            If matplotlib is not installed, what is drawn was not recorded, there is no body or no time, an argument is
            not one of these, or a plane is given for a column or a component for orbits.

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> figure = vv.problems.figure_eight().scene.run(t=[0.0, 1.0, 2.0]).plot(bodies=[0, 2])
        >>> len(figure.axes)
        2
        >>> spring = vv.Scene(vv.Particles([1.0], [[1.0, 0.0, 0.0]]), vv.Harmonic(k=1.0))
        >>> spring.run(t=np.linspace(0.0, 9.0, 99)).plot("position", component="x").axes[0].get_ylabel()
        'position, x'
        """
        from visviva.plot import plot_trajectory

        if column is not None:
            from visviva._plot_columns import plot_column

            if plane is not None:
                raise InvalidInput(
                    "plane", f"is of orbits, and {column!r} is drawn against time; say component= instead"
                )
            return plot_column(cast("Trajectory", self), column, bodies, component, ax)
        if component is not None:
            raise InvalidInput(
                "component", f"is of a column, as plot('position', component={component!r}); got no column"
            )
        return plot_trajectory(cast("Trajectory", self), bodies, plane, ax)

    def plot_phase(
        self, component: Literal["x", "y", "z"] | None = None, *, bodies: object = None, ax: Axes | None = None
    ) -> Axes:
        """Draw a component of the places against that of the velocities, a line for each body.

        Units: those of the scene.

        Parameters
        ----------
        component : {"x", "y", "z"}, optional
            Which; by default that in which the bodies go farthest.
        bodies : sequence of int or str, optional
            Which; all if not given.
        ax : matplotlib.axes.Axes, optional
            Where; a new one if not given.

        Returns
        -------
        matplotlib.axes.Axes
            A dot is where a body is at the end.

        Raises
        ------
        visviva.InvalidInput
            If position or velocity was not recorded, there is no body or no time, an argument is not one of these, or
            matplotlib is not installed.

        See Also
        --------
        EventTable.plot : the points at which the run passes through a section, ``out.events.plot()``.

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> spring = vv.Scene(vv.Particles([1.0], [[1.0, 0.0, 0.0]]), vv.Harmonic(k=1.0), vv.LinearDrag(tau=5.0))
        >>> ax = spring.run(t=np.linspace(0.0, 20.0, 401)).plot_phase()
        >>> ax.get_xlabel(), ax.get_ylabel()
        ('position, x', 'velocity, x')
        """
        from visviva._phase import plot_phase

        return plot_phase(cast("Trajectory", self), component, bodies, ax)

    def animate(
        self,
        path: str | PathLike[str] | None = None,
        *,
        bodies: object = None,
        plane: Literal["xy", "xz", "yz", "xyz"] | None = None,
        trail: float = 0.1,
        frames: int = 200,
        fps: int = 25,
    ) -> FuncAnimation:
        """Show the bodies as they move, and save that as a GIF, MP4 or HTML page.

        A rigid body whose orientation was recorded is drawn as the homogeneous box that has its mass and moments; from
        its fixed point, if it has one, a line goes to its center.

        Frames are outputs of the run, those nearest to evenly spaced times: give the run as many as should be seen.

        Parameters
        ----------
        path : str or PathLike, optional
            A file ending in ``.gif``, ``.html`` or ``.mp4``, which needs ffmpeg (``pip install 'visviva[video]'``
            brings one); nothing is written without a path.
        bodies : sequence of int or str, optional
            Which; all if not given.
        plane : str, optional
            As in `plot`; ``"xyz"`` if not given and there are boxes.
        trail : float
            For how much of the run, from 0 to 1 without dimension, the way of each body is shown behind it.
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
            If matplotlib or what writes the file is not installed, positions were not recorded, there is no body or no
            time, or an argument is not one of these.

        Examples
        --------
        >>> import os, tempfile, visviva as vv
        >>> out = vv.problems.figure_eight().scene.run(t=[0.0, 0.5, 1.0])
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     moving = out.animate(os.path.join(folder, "eight.gif"), plane="xy")
        ...     os.listdir(folder)
        ['eight.gif']
        """
        from visviva._animation import animate

        return animate(cast("Trajectory", self), path, bodies=bodies, plane=plane, trail=trail, frames=frames, fps=fps)
