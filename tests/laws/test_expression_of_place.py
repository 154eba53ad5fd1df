"""Potentials that take the place alone, or place and time: to the bit the force of place, velocity and time."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import visviva as vv

STONES = vv.Particles([1.0, 2.0], [[0.25, -0.5, 1.0], [1.5, 0.5, -0.25]], [[0.5, 0.25, -1.0], [0.0, 1.0, 0.5]])


def bowl(r: Any, k: Any) -> Any:
    return k * (r @ r) ** 2 / 4


class Bowl:
    """A potential that is an object, as of a program that holds more in it."""

    def __call__(self, position: Any, time: Any = 1.0, *, k: Any) -> Any:
        return bowl(position, k) + 0.0 * time


def moved(potential: Callable[..., Any], **parameters: float) -> Any:
    force = vv.ExpressionForce(potential=potential, parameters=parameters or None)
    return vv.Scene(STONES, force).run(t=np.linspace(0.0, 3.0, 4), record=("position", "energy"))


OF_PLACE: dict[str, Callable[..., Any]] = {
    "place": bowl,
    "place, time": lambda r, t, k: bowl(r, k),
    "a name that is given": lambda r, *, k: bowl(r, k),
    "with what is at hand": lambda r, power=2, *, k: k * (r @ r) ** power / 4,
    "an object": Bowl(),
}


@pytest.mark.parametrize("potential", OF_PLACE.values(), ids=OF_PLACE)
def test_a_potential_of_the_place_moves_as_one_of_the_state(potential: Callable[..., Any]) -> None:
    whole = moved(lambda r, v, t, k: bowl(r, k), k=3.0)
    found = moved(potential, k=3.0)
    assert np.array_equal(found.position, whole.position)
    assert np.array_equal(found.energy, whole.energy)
    # 1e-12 a step, of some fifty steps; energies are a few units.
    assert np.ptp(found.energy) < 5e-11


@pytest.mark.parametrize("name", ["t", "time"])
def test_a_potential_of_place_and_time_has_the_time(name: str) -> None:
    """V = −a t x: the velocity at t is a t²/2, the way a t³/6."""
    potentials = {"t": lambda r, t, a: -a * t * r[0], "time": lambda r, time, a: -a * time * r[0]}
    stone = vv.Particles([1.0], [[0.0, 0.0, 0.0]])
    out = vv.Scene(stone, vv.ExpressionForce(potential=potentials[name], parameters={"a": 6.0})).run(t=2.0)
    # A polynomial of the third degree, which a step has but for a few roundings.
    assert out.position[-1, 0, 0] == pytest.approx(8.0, rel=4e-15, abs=0)
    assert out.velocity[-1, 0, 0] == pytest.approx(12.0, rel=4e-15, abs=0)


# Every one of them is V = −12 x, with 2 and 6 for what has a default; of those with the time V = −6 t x.
KEPT: dict[str, Callable[..., Any]] = {
    "place": lambda r, depth=2.0: -6.0 * depth * r[0],
    "place and two": lambda r, depth=2.0, k=6.0: -depth * k * r[0],
    "place and three": lambda r, depth=2.0, k=6.0, one=1.0: -depth * k * one * r[0],
    "place and four": lambda r, depth=2.0, k=6.0, one=1.0, also=1.0: -depth * k * one * also * r[0],
    "state": lambda r, v, t, depth=2.0, k=6.0: -depth * k * r[0],
}
OF_TIME: dict[str, Callable[..., Any]] = {
    "place, time": lambda r, t, k=6.0: -k * t * r[0],
    "place, time and two": lambda r, time, k=6.0, one=1.0: -k * one * time * r[0],
    "a default of all": lambda r, t=0.0, k=6.0: -k * t * r[0],
    "state": lambda r, v=None, t=0.0, k=6.0: -k * t * r[0],
}


@pytest.mark.parametrize("potential", KEPT.values(), ids=KEPT)
def test_what_has_a_default_keeps_it(potential: Callable[..., Any]) -> None:
    """x = 12 t²/2; the third of them was taken for the time before, and the second for the velocity."""
    stone = vv.Particles([1.0], [[0.0, 0.0, 0.0]])
    for depth, parameters in ((2.0, None), (4.0, {"depth": 4.0})):
        force = vv.ExpressionForce(potential=potential, parameters=parameters)
        out = vv.Scene(stone, force).run(t=2.0)
        # A polynomial, which a step has but for a few roundings.
        assert out.position[-1, 0, 0] == pytest.approx(12.0 * depth, rel=4e-15, abs=0)


@pytest.mark.parametrize("potential", OF_TIME.values(), ids=OF_TIME)
def test_what_has_a_default_after_the_time_keeps_it(potential: Callable[..., Any]) -> None:
    stone = vv.Particles([1.0], [[0.0, 0.0, 0.0]])
    out = vv.Scene(stone, vv.ExpressionForce(potential=potential)).run(t=2.0)
    # x = t³, of a step likewise.
    assert out.position[-1, 0, 0] == pytest.approx(8.0, rel=4e-15, abs=0)


def test_what_may_be_the_time_or_a_value_is_refused() -> None:
    """Third of place and velocity, with a default and a name of its own: it was the time, whatever was meant."""
    told = r"expected the time in the third place, f\(position, velocity, t\), got s=2.5 there.*f\(.*, t, s=2.5\)"
    with pytest.raises(vv.InvalidInput, match=rf"^potential: {told}"):
        vv.ExpressionForce(potential=lambda r, v, s=2.5: -6.0 * s * r[0])
    with pytest.raises(vv.InvalidInput, match=rf"^force: {told}"):
        vv.ExpressionForce(force=lambda r, v, s=2.5: -s * r)
    with pytest.raises(vv.InvalidInput, match=rf"^acceleration: {told}"):
        vv.ExpressionForce(acceleration=lambda r, v, s=2.5: -s * r)
    with pytest.raises(vv.InvalidInput, match=r"^L: expected the time in the third place.*got m=2.5 there"):
        vv.Lagrangian(lambda q, v, m=2.5: m * v[0] ** 2 / 2, ["q"], position=[1.0])
    with pytest.raises(vv.InvalidInput, match=r"^H: expected the time in the third place.*got m=2.5 there"):
        vv.Hamiltonian(lambda q, p, m=2.5: p[0] ** 2 / m / 2, ["q"], position=[1.0], momentum=[1.0])


def test_coordinates_with_defaults_are_no_values() -> None:
    """Of V(x, y=0), with the place for x, y stood at 0."""
    with pytest.raises(vv.InvalidInput, match=r"^potential: .*x and y are one argument"):
        vv.ExpressionForce(potential=lambda x, y=0.0: x[0] ** 2 + y**2)
    with pytest.raises(vv.InvalidInput, match=r"^potential: .*x and y are one argument"):
        vv.ExpressionForce(potential=lambda x, y=0.0, z=0.0: x[0] ** 2 + y**2 + z**2)


def test_copies_have_parameters_of_their_own() -> None:
    scene = vv.Scene(STONES, vv.ExpressionForce(potential=bowl, parameters={"k": 1.0}))
    copies = scene.ensemble(parameters={"ExpressionForce": {"k": [1.0, 3.0]}}).run(t=3.0)
    for copy, k in enumerate((1.0, 3.0)):
        assert np.array_equal(copies[copy].position[-1], moved(bowl, k=k).position[-1])


@pytest.mark.parametrize(
    ("potential", "message"),
    [
        # Which of both the second is nobody can know.
        (lambda r, v: r[2], r"called with \(position, velocity, t\).*define it as f\(position, velocity, t\)"),
        (lambda r, v, t, s, u: r[2], "s"),
        (lambda x, y, z: 9.81 * z, r"x and y are one argument, whose parts are position\[0\] and position\[1\]"),
    ],
)
def test_other_functions_are_refused(potential: Callable[..., Any], message: str) -> None:
    with pytest.raises(vv.InvalidInput, match=message):
        vv.ExpressionForce(potential=potential)


def test_three_coordinates_are_no_place_velocity_and_time() -> None:
    """A spring along z, written so, would push with the time in the place of z."""
    with pytest.raises(vv.InvalidInput, match=r"^force: .*got f\(x, y, z\): x and y are one argument"):
        vv.ExpressionForce(force=lambda x, y, z: [0.0, 0.0, -9.81 * z])
    with pytest.raises(vv.InvalidInput, match=r"^L: .*got f\(x, y, t\): x and y are one argument"):
        vv.Lagrangian(lambda x, y, t: x[0] * y[0], ["x"], position=[1.0])


def test_what_fails_in_a_potential_of_the_place_is_told_by_its_name() -> None:
    def broken(r: Any) -> Any:
        raise KeyError(r)

    with pytest.raises(KeyError) as raised:
        vv.ExpressionForce(potential=broken)
    assert "broken" in raised.value.__notes__[0]


@pytest.mark.parametrize(
    "potential",
    [
        lambda r, k, t=0.0: -k * t * r[0],
        lambda r, k=6.0, *, t=1.0: -k * t * r[0],
        lambda r, *, time=1.0, k=6.0: -k * time * r[0],
        lambda r, depth=1.0, t=1.0, k=6.0: -k * depth * t * r[0],
    ],
)
def test_a_time_that_would_stand_still_is_refused(potential: Any) -> None:
    with pytest.raises(vv.InvalidInput, match="the time in the second or the third place"):
        vv.ExpressionForce(potential=potential, parameters={"k": 6.0})
