"""How a run in generalized coordinates is drawn: over time, in phase space, and as a moving picture."""

from __future__ import annotations

from abc import abstractmethod
from typing import TYPE_CHECKING, Literal, cast

from visviva._keywords import known_keywords
from visviva.generalized._columns import StateColumns

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from os import PathLike

    import numpy as np
    from matplotlib.animation import FuncAnimation
    from matplotlib.axes import Axes
    from numpy.typing import ArrayLike, NDArray

    from visviva.generalized._system import GeneralizedSystem
    from visviva.generalized._trajectory import GeneralizedTrajectory

__all__ = ["Drawn"]


@known_keywords
class Drawn(StateColumns):
    """A base of `GeneralizedTrajectory`: its pictures."""

    __slots__ = ()

    system: GeneralizedSystem
    t: NDArray[np.float64]

    @abstractmethod
    def __getitem__(self, name: str) -> NDArray[np.float64]:
        """A coordinate over time."""

    def plot(self, *, ax: Axes | None = None) -> Axes:
        """Draw the coordinates over time.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Where; a new one if not given.

        Returns
        -------
        matplotlib.axes.Axes

        Raises
        ------
        visviva.InvalidInput
            If matplotlib is not installed.

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> ax = vv.systems.pendulum().run(t=np.linspace(0, 10, 200)).plot()
        >>> ax.get_xlabel()
        't'
        """
        from visviva._style import legend_beside
        from visviva.plot import axes_or_new

        ax = axes_or_new(ax)
        for index, name in enumerate(self.system.coordinates):
            ax.plot(self.t, self.position[:, index], label=name)
        ax.set_xlabel("t")
        ax.set_ylabel(", ".join(self.system.coordinates) if len(self.system.coordinates) < 4 else "coordinates")
        if len(self.system.coordinates) > 1:
            legend_beside(ax)
        return ax

    def plot_phase(self, name: str | None = None, *, ax: Axes | None = None) -> Axes:
        """Draw a coordinate against its momentum.

        Parameters
        ----------
        name : str, optional
            The coordinate; the first if not given.
        ax : matplotlib.axes.Axes, optional
            Where; a new one if not given.

        Returns
        -------
        matplotlib.axes.Axes

        Raises
        ------
        InvalidInput
            For a coordinate that is not there, what are no axes, or if matplotlib is not installed.

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> ax = vv.systems.pendulum().run(t=np.linspace(0, 10, 200)).plot_phase("theta")
        >>> ax.get_xlabel()
        'theta'
        """
        from visviva.plot import axes_or_new

        name = self.system.coordinates[0] if name is None else name
        ax = axes_or_new(ax)
        ax.plot(self[name], self.momentum[:, self.system.coordinates.index(name)])
        ax.set_xlabel(name)
        ax.set_ylabel(f"momentum of {name}")
        return ax

    def animate(
        self,
        path: str | PathLike[str] | None = None,
        *,
        points: Callable[..., Sequence[Sequence[ArrayLike]]] | None = None,
        plane: Literal["xy", "xz", "yz", "xyz"] | None = None,
        trail: float = 0.1,
        frames: int = 200,
        fps: int = 25,
    ) -> FuncAnimation:
        """Show the system as it moves, its points joined by lines, and save that as a GIF, MP4 or HTML page.

        Frames are outputs of the run, those nearest to evenly spaced times: give the run as many as should be seen.

        Parameters
        ----------
        path : str or PathLike, optional
            A file ending in ``.gif``, ``.html`` or ``.mp4``, which needs ffmpeg (``pip install 'visviva[video]'``
            brings one); nothing is written without a path.
        points : callable, optional
            ``points(q, t, **parameters)`` gives the places of what is drawn, each of two or three numbers or arrays
            over time, in the order in which lines join them; ``q[0]`` is the first coordinate, shape (T,). Those of
            `systems` know theirs, with y upwards in a plane and z upwards in space.
        plane : str, optional
            What is shown: ``"xy"``, ``"xz"``, ``"yz"`` or ``"xyz"``; space where points have a third number, else xy.
        trail : float
            For how much of the run, from 0 to 1 without dimension, the way of each point is shown behind it.
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
        InvalidInput
            If nobody said where the points are, they are no numbers, the run has no time, matplotlib or what writes the
            file is not installed, or an argument is not one of these.

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> out = vv.systems.double_pendulum().run(t=np.linspace(0.0, 2.0, 51))
        >>> len(list(out.animate().new_frame_seq()))
        51

        A system of one's own says where its points are, here a bead on a parabola:

        >>> bead = vv.Lagrangian(
        ...     lambda q, v, t: v[0] ** 2 * (1 + 4 * q[0] ** 2) / 2 - 9.81 * q[0] ** 2, ["x"], position=[1.0]
        ... )
        >>> moving = bead.run(t=np.linspace(0.0, 2.0, 51)).animate(points=lambda q, t: [(q[0], q[0] ** 2)])
        """
        from visviva.generalized._points import animate

        return animate(
            cast("GeneralizedTrajectory", self), path, points, plane, {"trail": trail, "frames": frames, "fps": fps}
        )
