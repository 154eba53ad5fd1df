"""Moving pictures of runs: the bodies at outputs that are evenly spaced in time, and where each has been just before.

The one idea: a frame is an output of the run, the nearest one to its time; nothing is interpolated, so nothing is shown
that was not computed. What moves is `Places`: points and lines, be they those of bodies, of a system in generalized
coordinates or of something that turns.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from visviva._arrays import number, whole_number
from visviva._packages import needed
from visviva._paths import path_text
from visviva._style import COLORS, FRAME, legend_beside
from visviva.errors import InvalidInput, MissingPackage
from visviva.plot import chosen_bodies, directions, label_places, new_figure, set_ends

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.animation import FuncAnimation
    from numpy.typing import NDArray

    from visviva.trajectory import Trajectory

__all__ = ["Places", "animate", "animate_places"]

_SUFFIXES = (".gif", ".html", ".mp4")


@dataclass(frozen=True, slots=True)
class Places:
    """Points over time.

    Attributes
    ----------
    t : ndarray, shape (T,)
    position : ndarray, shape (T, P, 3)
    names : tuple of str, or None
        Of the points; without them there is no legend.
    lines : ndarray, shape (T, K, 3), or None
        What is drawn beside the points: a line through places that are given for each time, with NaN where it breaks.
    """

    t: NDArray[np.float64]
    position: NDArray[np.float64]
    names: tuple[str, ...] | None = None
    lines: NDArray[np.float64] | None = None


def animate(
    trajectory: Trajectory, path: Any, *, bodies: object, plane: str | None, trail: object, frames: object, fps: object
) -> FuncAnimation:
    """As `Trajectory.animate`."""
    from visviva._boxes import boxes

    chosen = chosen_bodies("animate", trajectory, bodies)
    known = trajectory.scene.particles.names
    names = tuple(known[body] for body in chosen) if known else None
    outlines = boxes(trajectory, chosen)
    places = Places(trajectory.t, trajectory.position[:, chosen], names, outlines)
    # What turns is seen from aside.
    shown = directions(trajectory.position, plane if plane is not None or outlines is None else "xyz")
    return animate_places(places, path, shown=shown, trail=trail, frames=frames, fps=fps)


def animate_places(
    places: Places, path: Any, *, shown: Sequence[int], trail: object, frames: object, fps: object
) -> FuncAnimation:
    """Show points as they move, in these directions of space."""
    most = whole_number("frames", frames, 1, 100_000)
    part, rate = number("trail", trail), whole_number("fps", fps, 1, 1000)
    if not 0.0 <= part <= 1.0:
        raise InvalidInput("trail", f"expected a part of the run from 0 to 1, got {part!r}")
    figure, (axes,) = new_figure(1, (6.0, 5.5), solid=(0,) if len(shown) == 3 else ())
    file = None if path is None else _file(path)
    return _saved(_moving(figure, axes, places, shown, _outputs(places.t, most), part, rate), file, rate)


def _outputs(t: NDArray[np.float64], most: int) -> NDArray[np.int64]:
    """The outputs that are nearest to evenly spaced times."""
    if len(t) == 1:
        return np.zeros(1, dtype=np.int64)
    wanted = np.linspace(t[0], t[-1], min(most, len(t)))
    forward = 1.0 if t[-1] >= t[0] else -1.0
    after = np.clip(np.searchsorted(forward * t, forward * wanted), 1, len(t) - 1)
    return np.unique(np.where(np.abs(t[after - 1] - wanted) <= np.abs(t[after] - wanted), after - 1, after))


def _moving(
    figure: Any,
    axes: Any,
    places: Places,
    shown: Sequence[int],
    outputs: NDArray[np.int64],
    trail: float,
    fps: int,
) -> FuncAnimation:
    from matplotlib.animation import FuncAnimation  # there is a figure: matplotlib is there
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    FigureCanvasAgg(figure)
    names, t, position = places.names, places.t, places.position[..., shown]
    joined = position[:, :0] if places.lines is None else places.lines[..., shown]
    everywhere = np.concatenate([position, joined], axis=1)
    set_ends(axes, np.nanmin(everywhere, axis=(0, 1)), np.nanmax(everywhere, axis=(0, 1)))
    label_places(axes, shown)
    if len(shown) == 2:
        axes.set_aspect("equal", adjustable="box")
    span = trail * (t[-1] - t[0])
    nothing: list[list[float]] = [[] for _ in shown]
    colors = [COLORS[at % len(COLORS)] for at in range(position.shape[1])]
    paths = [axes.plot(*nothing, linewidth=0.8, linestyle="-", color=color)[0] for color in colors]
    rods = [axes.plot(*nothing, linewidth=1.2, linestyle="-", color=FRAME, zorder=1)[0]] if joined.size else []
    marks = [
        axes.plot(*nothing, "o", markersize=5, color=color, label=names[at] if names else None)[0]
        for at, color in enumerate(colors)
    ]
    if names and len(names) <= len(COLORS):
        # Beside the picture: within it, something would move behind.
        legend_beside(axes)
    title = axes.set_title("")

    def draw(output: int) -> list[Any]:
        time = t[output]
        first = int(np.argmax(np.abs(time - t[: output + 1]) <= abs(span)))
        lines = [(rod, joined[output]) for rod in rods]
        for at, (path, mark) in enumerate(zip(paths, marks, strict=True)):
            lines += [(path, position[first : output + 1, at]), (mark, position[output : output + 1, at])]
        for line, of in lines:
            line.set_data(of[:, 0], of[:, 1])
            if len(shown) == 3:
                line.set_3d_properties(of[:, 2])
        title.set_text(f"t = {time:.6g}")
        return [*paths, *rods, *marks, title]

    animation = FuncAnimation(figure, draw, frames=outputs.tolist(), interval=1000.0 / fps)
    # The first frame is drawn, so that nobody is warned who does not look at it.
    figure.canvas.draw()
    return animation


def _file(path: Any) -> Path:
    """Where it goes, if there is a writer for it.

    Raises
    ------
    visviva.InvalidInput
        For another ending, or a writer that is not installed.
    """
    file = Path(path_text("path", path))
    if file.suffix not in _SUFFIXES:
        raise InvalidInput("path", f"expected a file ending in {', '.join(_SUFFIXES)}, got {str(path)!r}")
    if not file.parent.is_dir():
        raise InvalidInput("path", f"expected a file in a folder that exists, got {str(path)!r}")
    if file.suffix == ".mp4":
        _ffmpeg()
    return file


def _ffmpeg() -> str:
    """The program that writes .mp4: what matplotlib finds, or what the package imageio-ffmpeg brings.

    Raises
    ------
    visviva.MissingPackage
        If there is neither.
    """
    if needed("matplotlib.animation", "plot", "plot").writers.is_available("ffmpeg"):
        found: str = needed("matplotlib", "plot", "plot").rcParams["animation.ffmpeg_path"]
        return found
    instead = "install ffmpeg itself, or give a .gif or .html, which need neither"
    package = needed("imageio_ffmpeg", "path", "video", instead)
    try:
        brought: str = package.get_ffmpeg_exe()
    except RuntimeError as error:  # of a system that it brings none for
        raise MissingPackage(
            "path", f"imageio-ffmpeg has no ffmpeg for this system, which writes .mp4: {instead}"
        ) from error
    return brought


def _saved(animation: FuncAnimation, file: Path | None, fps: int) -> FuncAnimation:
    if file is None:
        return animation
    if file.suffix == ".html":
        file.write_text(animation.to_jshtml(fps=fps), encoding="utf-8")
    elif file.suffix == ".gif":
        animation.save(file, writer="pillow", fps=fps, dpi=100)
    else:
        from matplotlib import rc_context

        with rc_context({"animation.ffmpeg_path": _ffmpeg()}):
            animation.save(file, writer="ffmpeg", fps=fps, dpi=100)
    return animation


def __dir__() -> list[str]:
    return list(__all__)
