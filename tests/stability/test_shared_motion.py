"""What moves all bodies alike costs them no digits: the error of a step is held against what they do to each other."""

import numpy as np
import pytest

import visviva as vv

PAIR = vv.Particles([1.0, 1.0], [[-0.5, 0.0, 0.0], [0.5, 0.0, 0.0]], [[0.0, -0.7, 0.0], [0.0, 0.7, 0.0]])
GRAVITY = vv.Gravity(1.0)
DOWN = vv.UniformField((0.0, 0.0, -100.0))


def separation(*forces: vv.forces.Force, method: str = "dop853", rtol: float = 1e-9) -> np.ndarray:
    position = vv.Scene(PAIR, GRAVITY, *forces).run(t=10.0, method=method, rtol=rtol).position[-1]
    return position[1] - position[0]


@pytest.mark.parametrize("method", [method.name for method in vv.methods() if method.adaptive])
@pytest.mark.parametrize(
    ("with_whole", "without"),
    [
        ([DOWN], []),
        ([vv.LinearDrag(10.0), DOWN], [vv.LinearDrag(10.0)]),
        ([vv.UniformMagneticField((0.0, 0.0, 0.1)), DOWN], [vv.UniformMagneticField((0.0, 0.0, 0.1))]),
        ([vv.DrivenForce((0.0, 0.0, 100.0), frequency=0.01)], []),
    ],
    ids=["falling", "falling against drag", "falling in a magnetic field", "driven"],
)
def test_the_relative_motion_is_as_good_as_without(
    method: str, with_whole: list[vv.forces.Force], without: list[vv.forces.Force]
) -> None:
    """The whole goes 5000 lengths; equal masses, charges and drags, so that the relative motion is the same.

    Measured from where the pair began, its error was up to 1e5 times as large.
    """
    rtol = 1e-9 if method == "dop853" else 1e-7
    best = separation(*without, rtol=1e-13)
    alone = np.abs(separation(*without, method=method, rtol=rtol) - best).max()
    moving = np.abs(separation(*with_whole, method=method, rtol=rtol) - best).max()
    # Other steps err otherwise, by some factor; 5000 lengths away, rounding is 1e-12 and grows with the orbit's phase.
    assert moving < 4.0 * alone + 1e-10
