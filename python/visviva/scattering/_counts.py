"""The statistics of counts, and their picture beside what is expected."""

from __future__ import annotations

from math import lgamma
from typing import TYPE_CHECKING, Any

import numpy as np

from visviva._packages import needed

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from visviva.scattering._foil_tally import FoilTally
    from visviva.scattering._joint_tally import JointTally
    from visviva.scattering._tally import Tally

__all__ = ["plot_foil", "plot_joint", "plot_tally", "poisson_interval", "theory_is_known"]

# The normal distribution beyond one standard deviation: (1 - erf(1/√2))/2.
_TAIL = 0.15865525393145705
# Sums of Poisson terms up to here, the series beyond: 1e-6 of a count, and less and less.
_SUMMED = 500
# Residuals are drawn of bins in which so many are expected.
_EXPECTED = 1.0

_AXES = {
    "cm_angle": ("angle in the center-of-mass frame [degrees]", "dσ/dΩ [area per steradian]"),
    "lab_angle": ("laboratory angle [degrees]", "dσ/dΩ₁ [area per steradian]"),
    "recoil_angle": ("recoil angle [degrees]", "dσ/dΩ₂ [area per steradian]"),
    "energy": ("energy afterwards", "dσ/dE₁"),
    "recoil_energy": ("recoil energy", "dσ/dE₂"),
    "impact_parameter": ("impact parameter", "dσ/db"),
}
_FOIL_AXES = {
    "lab_angle": "angle from the beam",
    "transmitted_angle": "angle from the beam, transmitted",
    "reflected_angle": "angle from the beam, reflected",
    "transmitted_energy": "energy of transmitted ions [eV]",
    "reflected_energy": "energy of reflected ions [eV]",
    "stopped_depth": "depth of stopped ions [µm]",
    "cm_angle": "center-of-mass angle of the forced collision",
}
# Empty bins of a foil that are drawn beside those that have counted something.
_ROOM = 5


def poisson_interval(counts: NDArray[np.uint64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The means of which a count is neither among the least nor the greatest 15.87 %: the exact central interval."""
    different, back = np.unique(counts, return_inverse=True)
    low, high = np.zeros(different.shape), np.zeros(different.shape)
    for at, count in enumerate(different.tolist()):
        if count > _SUMMED:
            break
        # P(N ≥ n) of the lower end and P(N ≤ n) of the upper one are the tail.
        low[at] = _mean(count - 1, 1.0 - _TAIL) if count else 0.0
        high[at] = _mean(count, _TAIL)
    large = different > _SUMMED
    n = different[large].astype(np.float64)
    low[large], high[large] = _quantile(n, -1.0), _quantile(n + 1.0, 1.0)
    return low[back].reshape(counts.shape), high[back].reshape(counts.shape)


def _quantile(shape: Any, z: float) -> Any:
    """Of the gamma distribution at one standard deviation: Cornish and Fisher's series."""
    root = np.sqrt(shape)
    return shape + z * root - z / (6.0 * root) + 1.0 / (135.0 * shape) - z * 168.0 / (38880.0 * shape * root)


def _mean(count: int, probability: float) -> float:
    """The mean at which P(N ≤ count) is so much."""
    k = np.arange(count + 1)
    factorial = np.array([lgamma(each + 1.0) for each in k])
    mean = float(_quantile(count + 1.0, 1.0 if probability < 0.5 else -1.0))
    for _ in range(20):
        terms = np.exp(k * np.log(mean) - mean - factorial)
        # The derivative of the sum is less its last term.
        step = (float(terms.sum()) - probability) / float(terms[-1])
        mean = max(mean + step, 0.5 * mean)
        if abs(step) < 1e-13 * mean:
            break
    return mean


def theory_is_known(tally: Tally) -> bool:
    """Whether `Tally.expected` tells what is expected."""
    beam = tally.beam
    known = beam.energy_spread is None and not (beam.divergence and tally.name in ("lab_angle", "recoil_angle"))
    varying = any(isinstance(channel.probability, tuple) for channel in beam.channels)
    return known and not (varying and tally.name not in ("cm_angle", "impact_parameter"))


def plot_tally(tally: Tally, ax: Axes | None, residuals: Axes | None) -> Axes:
    """A picture of a tally; see `Tally.plot`."""
    from visviva._residuals import data_and_residuals
    from visviva._style import BLUE, VERMILION, legend_within

    known = theory_is_known(tally)
    axes, lower = data_and_residuals(ax, residuals, (5.5, 5.0 if known else 4.0), known=known)
    angle = tally.name.endswith("angle")
    edges = np.degrees(tally.edges) if angle else tally.edges
    # Of the disc, bin by bin: what is beyond it is missing from the simulation and from what is expected alike.
    scale = np.pi * tally.b_max**2 / (tally.n_events * tally._measure())
    counts = tally.expected() if known else np.full(scale.shape, np.nan)
    expected = counts * scale
    # Where nothing can come the interval of no count would say that something might.
    shown = np.where((tally.counts > 0) | (expected > 0.0) | (not known), scale, np.nan)
    if tally.by_stratum is None:
        ends, band = poisson_interval(tally.counts), "central 68 % of Poisson"
    else:
        error = np.sqrt(tally.variances())
        ends, band = (tally.values() - error, tally.values() + error), "one standard deviation"
    low, high = (np.append(end * shown, np.nan) for end in ends)
    axes.fill_between(edges, low, high, step="post", alpha=0.35, linewidth=0.0, color=BLUE, label=band)
    axes.stairs(tally.values() * scale, edges, linewidth=1.0, color=BLUE, label=f"{tally.n_events} events")
    if known:
        axes.stairs(expected, edges, linewidth=1.0, color=VERMILION, linestyle="--", label="theory")
    across, up = _AXES[tally.name]
    axes.set(ylabel=up)
    (axes if lower is None else lower).set_xlabel(across)
    drawn = np.concatenate([(tally.values() * scale)[tally.counts > 0], expected[expected > 0.0]])
    if drawn.size and drawn.max() > 30.0 * drawn.min():
        axes.set_yscale("log")
        axes.set_ylim(0.5 * drawn.min(), 2.0 * drawn.max())
    widths = np.diff(tally.edges)
    if tally.edges[0] > 0.0 and widths[-1] > 30.0 * widths[0]:
        axes.set_xscale("log")
    legend_within(axes)
    if lower is not None:
        lower.set_xscale(axes.get_xscale())
        _pulls(tally, edges, counts, lower)
    return axes


def _pulls(tally: Tally, edges: NDArray[np.float64], expected: NDArray[np.float64], axes: Axes) -> None:
    """How many standard deviations the values are from what is expected, within a band of one."""
    from visviva._residuals import mark_none
    from visviva._style import BLUE

    if tally.by_stratum is None:
        # Of what is expected, binomial: that of a count of none would be none.
        variance = expected * (1.0 - expected / tally.n_events)
        # Where one event more or less is all there is, its distance is no number of standard deviations.
        plotted = (variance > 0.0) & (expected >= _EXPECTED)
    else:
        variance = tally.variances()
        plotted = variance > 0.0
    middle = 0.5 * (edges[1:] + edges[:-1])
    if axes.get_xscale() == "log":
        middle = np.sqrt(edges[1:] * edges[:-1])
    pulls = (tally.values() - expected)[plotted] / np.sqrt(variance[plotted])
    axes.plot(middle[plotted], pulls, ".", markersize=4, color=BLUE)
    mark_none(axes, 0.0, 1.0)
    reach = 1.15 * max(3.0, float(np.abs(pulls).max()) if pulls.size else 0.0)
    axes.set(ylim=(-reach, reach), ylabel="(n − theory) / σ")


def plot_foil(tally: FoilTally, ax: Axes | None) -> Axes:
    """A picture of what a foil does; see `FoilTally.plot`."""
    from visviva._style import BLUE
    from visviva.plot import axes_or_new

    axes = axes_or_new(ax)
    value, error = tally.fraction()
    angle = tally.name.endswith("angle")
    edges = np.degrees(tally.edges) if angle else tally.edges
    axes.stairs(value, edges, linewidth=1.0, color=BLUE)
    low, high = np.append(value - error, 0.0), np.append(value + error, 0.0)
    axes.fill_between(edges, np.maximum(low, 0.0), high, step="post", alpha=0.3, linewidth=0.0, color=BLUE)
    axes.set(xlabel=_FOIL_AXES[tally.name] + (" [degrees]" if angle else ""), ylabel="part of the ions per bin")
    # Numbers of so many digits would lie on each other.
    axes.locator_params(axis="x", nbins=5)
    if angle and value.any():
        axes.set_yscale("log")
        axes.set_ylim(0.5 * value[value > 0.0].min(), 2.0 * value.max())
    counted = np.flatnonzero(tally.counts)
    if counted.size:
        first, last = max(counted[0] - _ROOM, 0), min(counted[-1] + 1 + _ROOM, len(edges) - 1)
        axes.set_xlim(edges[first], edges[last])
    return axes


def plot_joint(tally: JointTally, ax: Axes | None) -> Axes:
    """A picture of a histogram of two quantities; see `JointTally.plot`."""
    from visviva.errors import InvalidInput
    from visviva.plot import axes_or_new

    colors = needed("matplotlib.colors", "plot", "plot")
    if len(tally.name) != 2:
        raise InvalidInput("plot", f"expected a tally of two quantities, got {len(tally.name)}: sum over the others")
    axes = axes_or_new(ax)
    across, up = (np.degrees(e) if n.endswith("angle") else e for n, e in zip(tally.name, tally.edges, strict=True))
    values = tally.values()
    seen = values[values > 0.0]
    wide = bool(seen.size) and seen.max() > 30.0 * seen.min()
    most = float(seen.max()) if seen.size else 1.0
    norm = colors.LogNorm(seen.min(), most) if wide else colors.Normalize(0.0, most)
    # What counted nothing is left white, and is no color of the scale.
    shown = axes.pcolormesh(across, up, np.where(values > 0.0, values, np.nan).T, norm=norm, cmap="viridis_r")
    axes.figure.colorbar(shown, ax=axes, label="events per bin")
    axes.set(xlabel=_AXES[tally.name[0]][0], ylabel=_AXES[tally.name[1]][0])
    return axes
