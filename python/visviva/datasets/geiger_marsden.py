"""The counts by which Geiger and Marsden found that atoms have nuclei.

Digits: H. Geiger, E. Marsden, *The laws of deflexion of α particles through large angles*, Phil. Mag. 25
(1913) 604, table II.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from visviva._html import Record
from visviva._keywords import known_keywords

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

__all__ = ["GeigerMarsden", "RutherfordComparison", "geiger_marsden_1913"]

# Angle in degrees, 1/sin⁴(φ/2) as printed, scintillations for silver and for gold.
_TABLE = (
    (150.0, 1.149, 22.2, 33.1),
    (135.0, 1.373, 27.4, 43.0),
    (120.0, 1.778, 33.0, 51.9),
    (105.0, 2.524, 47.3, 69.5),
    (75.0, 7.281, 136.0, 211.0),
    (60.0, 16.00, 320.0, 477.0),
    (45.0, 46.63, 989.0, 1435.0),
    (37.5, 93.67, 1760.0, 3300.0),
    (30.0, 222.9, 5260.0, 7800.0),
    (22.5, 690.3, 20300.0, 27300.0),
    (15.0, 3445.0, 105400.0, 132000.0),
)


@known_keywords
@dataclass(frozen=True, eq=False, repr=False)
class RutherfordComparison(Record):
    """Counts against Rutherford's law, one scale fitted to each metal.

    Units: angles in degrees; ratios are without dimension.

    Attributes
    ----------
    metal : str
        ``"silver"`` or ``"gold"``.
    angle : ndarray, shape (11,)
        Degrees.
    scale : float
        The geometric mean of N·sin⁴(φ/2): every count has the same weight in the logarithm, since the
        errors of the experiment were relative.
    ratio : ndarray, shape (11,)
        Counted over scale / sin⁴(φ/2).

    References
    ----------
    H. Geiger & E. Marsden, Phil. Mag. 25 (1913) 604, table II. The law: E. Rutherford, Phil. Mag. 21 (1911) 669.

    Examples
    --------
    >>> import visviva as vv
    >>> silver, gold = vv.datasets.geiger_marsden_1913().compare()
    >>> gold.metal, gold.ratio.shape
    ('gold', (11,))
    """

    metal: str
    angle: NDArray[np.float64]
    scale: float
    ratio: NDArray[np.float64]

    def __str__(self) -> str:
        rows = [f"{self.metal}: N = {self.scale:.2f} / sin⁴(φ/2)", f"{'φ':>7}{'counted / law':>16}"]
        rows += [f"{angle:>6.1f}°{ratio:>16.3f}" for angle, ratio in zip(self.angle, self.ratio, strict=True)]
        return "\n".join(rows)

    def plot(self, *, ax: Axes | None = None, residuals: Axes | None = None) -> Axes:
        """Draw the counts and the law, and below counts over law; the band is 5 %, as errors of these counts are taken.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Where to draw the counts; by default in a new figure, ``.figure`` of what is returned, whose
            ``.figure.axes[1]`` is the panel below.
        residuals : matplotlib.axes.Axes, optional
            With `ax`, where the ratio goes; without it, it is not drawn.

        Returns
        -------
        matplotlib.axes.Axes
            Of the counts.

        Raises
        ------
        visviva.InvalidInput
            If matplotlib is not installed; for `residuals` without `ax`.

        Examples
        --------
        Both metals in one picture:

        >>> import visviva as vv
        >>> silver, gold = vv.datasets.geiger_marsden_1913().compare()
        >>> ax = silver.plot()
        >>> _ = gold.plot(ax=ax, residuals=ax.figure.axes[1])
        >>> ax.get_ylabel(), ax.figure.axes[1].get_ylabel()
        ('scintillations', 'over the law')
        """
        from visviva.datasets._pictures import plot_counts

        def law(degrees: NDArray[np.float64]) -> NDArray[np.float64]:
            return np.asarray(self.scale / np.sin(np.radians(degrees) / 2.0) ** 4)

        return plot_counts(ax, residuals, self.metal, self.angle, self.ratio * law(self.angle), law)


@known_keywords
@dataclass(frozen=True, eq=False, repr=False)
class GeigerMarsden(Record):
    """Scintillations counted behind a foil, by angle.

    Attributes
    ----------
    angle : ndarray, shape (11,)
        Deflection φ in degrees, as printed.
    inverse_sin4 : ndarray, shape (11,)
        1/sin⁴(φ/2) as printed, to four digits.
    silver, gold : ndarray, shape (11,)
        Scintillations, corrected by the authors for the decay of the source and the natural effect.
    source : str
        The paper and the table.

    References
    ----------
    H. Geiger & E. Marsden, Phil. Mag. 25 (1913) 604, table II.

    Examples
    --------
    >>> import visviva as vv
    >>> data = vv.datasets.geiger_marsden_1913()
    >>> data.angle.max(), data.gold.shape
    (np.float64(150.0), (11,))
    """

    angle: NDArray[np.float64]
    inverse_sin4: NDArray[np.float64]
    silver: NDArray[np.float64]
    gold: NDArray[np.float64]
    source: str

    def compare(self) -> tuple[RutherfordComparison, RutherfordComparison]:
        """Compare both metals with Rutherford's law N ∝ 1/sin⁴(φ/2).

        Returns
        -------
        tuple of RutherfordComparison
            For silver and gold.

        Examples
        --------
        >>> import visviva as vv
        >>> silver, gold = vv.datasets.geiger_marsden_1913().compare()
        >>> print(f"{gold.scale:.1f}, from {gold.ratio.min():.2f} to {gold.ratio.max():.2f}")
        32.0, from 0.86 to 1.24
        """
        return self._against("silver"), self._against("gold")

    def _against(self, metal: str) -> RutherfordComparison:
        products = getattr(self, metal) * np.sin(np.radians(self.angle) / 2.0) ** 4
        scale = float(np.exp(np.mean(np.log(products))))
        return RutherfordComparison(metal, self.angle, scale, products / scale)


@known_keywords
def geiger_marsden_1913() -> GeigerMarsden:
    """Give table II of Geiger and Marsden's paper of 1913: silver and gold, 15° to 150°.

    Returns
    -------
    GeigerMarsden
        Angles, counts and the source. The counts fall 4000-fold while N·sin⁴(φ/2) stays within a factor 1.6; it drifts
        upward at small angles. Arrays have shape (11,), angles are in degrees.

    References
    ----------
    H. Geiger & E. Marsden, Phil. Mag. 25 (1913) 604, table II.

    Examples
    --------
    >>> import visviva as vv
    >>> data = vv.datasets.geiger_marsden_1913()
    >>> data.angle[:3], data.gold[:3]
    (array([150., 135., 120.]), array([33.1, 43. , 51.9]))
    """
    angle, inverse_sin4, silver, gold = np.array(_TABLE).T.copy()
    for column in (angle, inverse_sin4, silver, gold):
        column.setflags(write=False)
    return GeigerMarsden(
        angle,
        inverse_sin4,
        silver,
        gold,
        "H. Geiger, E. Marsden, Phil. Mag. 25 (1913) 604, table II",
    )


def __dir__() -> list[str]:
    return list(__all__)
