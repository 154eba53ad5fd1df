"""The conservation laws over random closed scenes, for every method there is."""

from itertools import pairwise

import numpy as np
import pytest
from closed_scenes import (
    END,
    METHODS,
    NAMES,
    ROUND_OFF,
    arrays,
    closed_scenes,
    distance,
    energy_changes,
    energy_error,
    run,
    state_error,
    step,
    tolerance,
)
from hypothesis import example, given, settings
from numpy.typing import NDArray

import visviva as vv

#: The second term of the energy's error of blanes_moan_rkn4 takes a fifth of the first from it, at the end.
TERMS_THAT_CANCEL = vv.Scene(
    vv.Particles(
        [1.0, 1.17, 1.93, 0.03],
        [[-0.92, -0.21, 0.39], [-0.71, -0.43, 0.84], [-0.96, 0.67, -0.31], [0.86, -0.73, -0.19]],
    ),
    vv.Gravity(0.98, softening=0.59),
)


@pytest.mark.parametrize("method", METHODS, ids=NAMES)
@given(scene=closed_scenes())
@settings(max_examples=40)
def test_momentum_and_center_of_mass(method: vv.Method, scene: vv.Scene) -> None:
    """Linear invariants: every method keeps them to round-off."""
    table = run(scene, method).conservation()
    # Worst: 9e-16 and 1.9e-15.
    assert table.momentum.max * table.momentum.scale < 4e-15
    assert table.center_of_mass.max * table.center_of_mass.scale < 8e-15


@pytest.mark.parametrize("method", METHODS, ids=NAMES)
@given(scene=closed_scenes(), about=arrays((3,), -2.0, 2.0))
@settings(max_examples=40)
def test_angular_momentum(method: vv.Method, scene: vv.Scene, about: NDArray[np.float64]) -> None:
    """A quadratic invariant: symplectic methods keep it to round-off, the others as well as the state."""
    drift = run(scene, method).conservation(about=about).angular_momentum
    # Worst of the symplectic: 2.0e-15.
    bound = 8e-15
    if not method.symplectic:
        # Σ m (|r - a| δv + |v| δx), to first order, twice.
        bodies = scene.particles
        speed = float(np.linalg.norm(bodies.velocity, axis=1).max()) + 10.0
        arm = float(np.linalg.norm(bodies.position - about, axis=1).max()) + speed * END
        bound += 2.0 * float(bodies.mass.sum()) * (arm + speed) * state_error(scene, method)
    assert drift.max * drift.scale < bound


@pytest.mark.parametrize("method", METHODS, ids=NAMES)
@given(scene=closed_scenes())
@example(scene=TERMS_THAT_CANCEL)
@settings(max_examples=40)
def test_energy_within_the_methods_own_bound(method: vv.Method, scene: vv.Scene) -> None:
    """As well as the state; and a symplectic, reversible method's error falls by 2ᵖ when its step is halved."""
    drift = run(scene, method).conservation().energy
    error = drift.max * drift.scale
    assert error < energy_error(scene, state_error(scene, method)) + 1e-14
    if method.symplectic and method.reversible:
        # The error at each time is a series in h², a hᵖ + b hᵖ⁺² + …, whose second term may be the opposite of much of
        # the first, where that was made small (blanes_moan_rkn4). But for hᵖ⁺⁴, 2ᵖ times the error of half a step is
        # ¾ b hᵖ⁺² off that of the step: a quarter of the 3 b hᵖ⁺² that 2⁻ᵖ times that of two is. Worst: 1.001.
        twice, once = (energy_changes(run(scene, method, dt=factor * step(method))) for factor in (2, 1))
        second_term = distance(twice / 2.0**method.order, once) / 4.0
        half = run(scene, method, dt=step(method) / 2).conservation().energy
        assert half.max * half.scale <= 1.02 * (error + second_term) / 2.0**method.order + 1e-14


@pytest.mark.parametrize(
    "method", [method for method in METHODS if not method.adaptive], ids=lambda method: method.name
)
@given(scene=closed_scenes())
@settings(max_examples=20)
def test_the_error_falls_as_the_order_says(method: vv.Method, scene: vv.Scene) -> None:
    """What the other bounds are made of cannot be anything: halving the step leaves 2⁻ᵖ of the error, or round-off."""
    ends = [run(scene, method, dt=step(method) / 2**halvings) for halvings in range(3)]
    (early, late) = (max(distance(a.position, b.position), distance(a.velocity, b.velocity)) for a, b in pairwise(ends))
    assert early < 0.1
    assert late < 2.0 * early / 2.0 ** min(method.order, 6) + ROUND_OFF


@pytest.mark.parametrize("method", [method for method in METHODS if method.adaptive], ids=lambda method: method.name)
@given(scene=closed_scenes())
@settings(max_examples=20)
def test_a_tolerance_is_what_it_says(method: vv.Method, scene: vv.Scene) -> None:
    """The error is within fifty tolerances of a run that is thirty times as tight."""
    loose, tight = run(scene, method), run(scene, method, rtol=tolerance(method) / 30.0)
    apart = max(distance(loose.position, tight.position), distance(loose.velocity, tight.velocity))
    assert apart < state_error(scene, method)
