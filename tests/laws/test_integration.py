"""Integration against what is known of a motion: its closed form, or what a central field keeps."""

import numpy as np
import pytest
from closed_scenes import METHODS, arrays, distance
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

import visviva as vv


@given(
    masses=st.tuples(st.floats(0.1, 2.0), st.floats(0.0, 2.0)),
    apart=arrays((3,), 0.5, 2.0),
    velocity=arrays((2, 3), -1.0, 1.0),
    end=st.floats(-2.0, 2.0).filter(lambda t: abs(t) > 1e-3),
)
@settings(max_examples=100)
def test_two_bodies_closed_form_and_integration(
    masses: tuple[float, float], apart: NDArray[np.float64], velocity: NDArray[np.float64], end: float
) -> None:
    """Kepler's solution against DOP853, over ellipses and hyperbolas that stay apart."""
    bodies = vv.Particles(masses, np.stack([np.zeros(3), apart]), velocity)
    scene = vv.Scene(bodies, vv.Gravity(0.25))
    closed = scene.run(t=end)
    assert closed.plan.closed_form
    assert closed.stats.steps == 0
    try:
        integrated = scene.run(t=end, method="dop853", rtol=1e-13)
    except vv.CloseEncounter:
        # Head-on: only the closed form passes.
        assume(False)
    # A grazing pericenter amplifies the tolerance; the energy says how close they came.
    relative = closed.velocity[:, 1] - closed.velocity[:, 0]
    amplification = 1.0 + float(np.abs(relative).max()) ** 4
    assert distance(closed.position, integrated.position) < 2e-10 * amplification


@given(
    state=arrays((2, 4, 3), -10.0, 10.0),
    g=arrays((3,), -10.0, 10.0),
    end=st.floats(-10.0, 10.0).filter(lambda t: abs(t) > 1e-3),
    method=st.sampled_from(METHODS),
)
def test_uniform_field_closed_form_and_integration(
    state: NDArray[np.float64], g: NDArray[np.float64], end: float, method: vv.Method
) -> None:
    """Every method of order 2 and more is exact on a parabola, whatever its step; one of order 1 errs by ½ g h t."""
    scene = vv.Scene(vv.Particles(np.ones(4), *state), vv.UniformField(g))
    closed = scene.run(t=end)
    assert closed.plan.closed_form
    how: dict[str, object] = {"rtol": 1e-9} if method.adaptive else {"dt": end / 7}
    integrated = scene.run(t=end, method=method.name, **how)  # type: ignore[arg-type]
    # Positions reach 10 + 100 + 500: a few roundings of 600.
    first_order = float(np.abs(g).max()) * abs(end) * abs(end / 7) if method.order < 2 else 0.0
    assert distance(closed.position, integrated.position) < 2e-12 + first_order
    assert distance(closed.velocity, integrated.velocity) < 2e-13


@given(velocity=arrays((3, 3), -10.0, 10.0), position=arrays((3, 3), -10.0, 10.0), end=st.floats(-100.0, 100.0))
def test_force_free_motion(velocity: NDArray[np.float64], position: NDArray[np.float64], end: float) -> None:
    """Momentum constant to the last bit; straight lines rounded once from the exact product and sum."""
    out = vv.Scene(vv.Particles([1.0, 0.0, 2.0], position, velocity)).run(t=[0.0, end] if end else 0.0)
    assert np.array_equal(out.velocity[-1], velocity)
    expected = position.astype(np.longdouble) + velocity.astype(np.longdouble) * np.longdouble(end)
    spacing = np.spacing(np.abs(position) + np.abs(velocity * end))
    assert np.all(np.abs(out.position[-1] - expected.astype(np.float64)) <= spacing)


@pytest.mark.parametrize(
    "potential",
    [vv.potentials.Coulomb(k=-1.0), vv.potentials.Yukawa(k=-1.0, length=2.0), vv.potentials.LennardJones(0.5, 1.0)],
    ids=repr,
)
@given(direction=arrays((3,), -1.0, 1.0), velocity=arrays((3,), -0.5, 0.5), distance=st.floats(1.0, 2.0))
@settings(max_examples=40)
def test_central_fields(
    potential: vv.potentials.Potential,
    direction: NDArray[np.float64],
    velocity: NDArray[np.float64],
    distance: float,
) -> None:
    """Energy and angular momentum about the center, and a motion that stays in its plane."""
    direction = direction + np.array([2.0, 0.0, 0.0])
    position = distance * direction / np.linalg.norm(direction)
    # Enough sideways motion to keep away from the center.
    velocity = velocity + 0.7 * np.cross([0.0, 0.0, 1.0], direction)
    scene = vv.Scene(vv.Particles([1.0], position[None], velocity[None]), vv.CentralField(potential))
    out = scene.run(t=np.linspace(0.0, 2.0, 5), method="dop853", rtol=1e-12)
    table = out.conservation()
    # Some steps of a tolerance of 1e-12, magnified where the path comes near to the center; measured 3e-12.
    assert table.energy.max * table.energy.scale < 1e-10
    assert table.angular_momentum.max * table.angular_momentum.scale < 1e-10
    normal = scene.invariants().angular_momentum
    assert np.abs(out.position[:, 0] @ (normal / np.linalg.norm(normal))).max() < 1e-10
