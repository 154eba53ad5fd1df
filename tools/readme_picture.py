"""The picture on the README's first screen: `python tools/readme_picture.py docs/first-look.png`.

Three results as they draw themselves, so that nothing in it is drawn by hand.
"""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

import numpy as np

import visviva as vv
from visviva.plot import new_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def first_look() -> Figure:
    """Three bodies that meet, order and chaos in a section, and rainbows of scattering."""
    figure, (bodies, section, rainbow) = new_figure(3, (12.0, 3.4))
    encounter = vv.problems.pythagorean().scene.run(t=np.linspace(0.0, 30.0, 6001), rtol=1e-13)
    encounter.plot(plane="xy", ax=bodies)
    bodies.set_title("three bodies of masses 3, 4 and 5")
    for y, p_y in ((0.0, 0.1), (0.0, 0.2), (0.0, 0.3), (0.3, 0.0), (0.45, 0.0), (0.55, 0.0), (-0.2, 0.0), (-0.1, 0.0)):
        p_x = np.sqrt(2.0 / 8.0 - p_y**2 - y**2 + 2.0 * y**3 / 3.0)
        points = vv.systems.henon_heiles(position=[0.0, y], momentum=[p_x, p_y]).poincare("x", t=1500.0)
        points.plot("y", ax=section)
    section.set_title("order and chaos: Hénon and Heiles")
    argon = vv.potentials.LennardJones(epsilon=1.0, sigma=1.0)
    energies = [[1.0], [2.0], [4.0]]
    vv.scattering.deflect(argon, energy=energies, impact_parameter=np.linspace(0.0, 3.0, 901)).plot(ax=rainbow)
    rainbow.set_title("rainbows of argon")
    return figure


if __name__ == "__main__":
    first_look().savefig(sys.argv[1], dpi=80)
