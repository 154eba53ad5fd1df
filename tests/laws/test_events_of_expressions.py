"""Expressions among the events of scenes: what a function of Python finds, at the speed of the other events.

Bounds: times of both agree to 1e-12 of the run, as both are located to round-off on one solution.
"""

from __future__ import annotations

import pickle
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from event_scenes import BY_NAME, METHODS, kepler

import visviva as vv

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

SPAN = 12.0


def transit(t: Any, position: Any, velocity: Any) -> Any:
    return position[1, 0] - position[0, 0]


def apart(t: Any, position: Any, velocity: Any) -> Any:
    between = position[1] - position[2]
    return np.sqrt(between @ between) - 1.2


def radial(t: Any, position: Any, velocity: Any) -> Any:
    return (position[1] - position[0]) @ (velocity[1] - velocity[0]) - 1e-3


def wave(t: Any, position: Any, velocity: Any) -> Any:
    return np.sin(3.0 * t) + position[1, 1]


def speed(t: Any, position: Any, velocity: Any) -> Any:
    return np.hypot(velocity[2, 0], velocity[2, 1]) - 0.8


def cube(t: Any, position: Any, velocity: Any) -> Any:
    return position[2, 1] ** 3 - 0.5


def moving_plane(t: Any, position: Any, velocity: Any) -> Any:
    return position[1, 1] - 0.1 * t


FUNCTIONS = [transit, apart, radial, wave, speed, cube, moving_plane]
EXPRESSIONS = [vv.events.expression(function) for function in FUNCTIONS]


def planets(masses: tuple[float, float] = (1e-3, 5e-4)) -> vv.Scene:
    """A star and two planets, none of which rests."""
    position = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.6, 0.1]]
    velocity = [[0.02, 0.0, 0.0], [0.0, 1.0, 0.0], [-(1.6**-0.5), 0.0, 0.0]]
    names = ["star", "b", "c"]
    return vv.Scene(vv.Particles([1.0, *masses], position, velocity, names=names), vv.Gravity(G=1.0))


def copies(scene: vv.Scene, members: int = 19) -> vv.EnsembleScene:
    factors = np.linspace(0.95, 1.05, members)[:, None, None]
    return scene.ensemble(velocity=scene.particles.velocity * factors)


def how(method: Any) -> dict[str, Any]:
    return {"method": method} | ({"rtol": 1e-10} if BY_NAME[method].adaptive else {"dt": 0.02})


def same(found: Any, expected: Any) -> None:
    """Of events that come at one instant, which is first is rounding's choice: one event after another."""
    assert len(expected)
    assert len(found) == len(expected)
    for which in range(len(FUNCTIONS)):
        one, other = found.of(which), expected.of(which)
        assert np.array_equal(one.member, other.member)
        np.testing.assert_allclose(one.t, other.t, rtol=0.0, atol=1e-12 * SPAN)
        np.testing.assert_allclose(one.position, other.position, rtol=0.0, atol=1e-11)


def identical(first: Any, second: Any) -> None:
    for name in ("which", "t", "position", "velocity", "member"):
        assert getattr(first, name).tobytes() == getattr(second, name).tobytes(), name


# Of methods of a low order the step is coarse, which both find the same events on.
@pytest.mark.filterwarnings("ignore::visviva.AccuracyWarning")
@pytest.mark.parametrize("method", METHODS)
def test_an_expression_finds_what_its_function_finds(method: str) -> None:
    scene = planets()
    try:
        plain = scene.run(SPAN, **how(method))
    except vv.InvalidInput:
        pytest.skip("a method that these forces cannot have")
    found = scene.run(SPAN, events=EXPRESSIONS, **how(method))
    same(found.events, scene.run(SPAN, events=FUNCTIONS, **how(method)).events)
    assert found.position.tobytes() == plain.position.tobytes()


@pytest.mark.parametrize("method", ["leapfrog", "rk4", "kahan_li8", "dop853", "verner98", "taylor"])
@pytest.mark.parametrize("masses", [(1e-3, 5e-4), (1e-3, 0.0), (0.0, 0.0)])
def test_copies_find_what_each_finds_alone(method: str, masses: tuple[float, float]) -> None:
    scene = copies(planets(masses))
    asked = {"events": EXPRESSIONS, **how(method)}
    together = scene.run(SPAN, threads=1, **asked).events
    identical(scene.run(SPAN, threads=3, **asked).events, together)
    for member in (0, 8, 18):
        alone = scene[member].run(SPAN, **asked).events
        for name in ("which", "t", "position", "velocity"):
            assert np.array_equal(
                getattr(together, name)[together.member == member], getattr(alone, name), equal_nan=True
            ), name


def test_copies_with_masses_of_their_own() -> None:
    scene = planets()
    masses = scene.particles.mass * np.linspace(0.5, 1.5, 11)[:, None]
    some = scene.ensemble(mass=masses)
    for method in ("leapfrog", "dop853"):
        asked = how(method)
        same(some.run(SPAN, events=EXPRESSIONS, **asked).events, some.run(SPAN, events=FUNCTIONS, **asked).events)


@pytest.mark.parametrize("method", ["leapfrog", "dop853", "taylor"])
@pytest.mark.parametrize("direction", [1, -1])
def test_a_terminal_one_ends_the_run_as_its_function_does(method: str, direction: Any) -> None:
    expression = vv.events.expression(transit, direction=direction, terminal=2)
    function = vv.events.function(transit, direction=direction, terminal=2)
    one, other = (planets().run(SPAN, events=[event], **how(method)) for event in (expression, function))
    assert one.status == other.status == vv.Status.STOPPED
    assert abs(one.final.t0 - other.final.t0) < 1e-12 * SPAN
    assert len(one.events) == 2
    # What goes on from there does not find it again.
    again = one.final.run(one.final.t0 + 1.0, events=[expression], **how(method))
    assert not len(again.events)


@pytest.mark.parametrize("method", ["dop853", "leapfrog"])
def test_runs_backwards(method: str) -> None:
    events = [vv.events.expression(function, direction=1) for function in FUNCTIONS]
    functions = [vv.events.function(function, direction=1) for function in FUNCTIONS]
    same(planets().run(-SPAN, events=events, **how(method)).events,
         planets().run(-SPAN, events=functions, **how(method)).events)  # fmt: skip


@pytest.mark.parametrize("method", ["dop853", "verner98", "rk4"])
def test_pairs_of_zeros_in_one_step_are_found(method: Any) -> None:
    """A free body comes to within a distance for a short while, at any place of a long step."""
    step = 1.0
    for passed in np.linspace(0.03, 0.97, 29):
        for written in (lambda r: np.sqrt(r @ r) - 0.02, lambda r: r @ r - 4e-4):
            free = vv.Scene(vv.Particles([1.0], [[-passed, 0.0, 0.0]], [[1.0, 0.0, 0.0]]), vv.LinearDrag(1e9))
            asked: dict[str, Any] = {"method": method} | ({} if BY_NAME[method].adaptive else {"dt": step})

            def near(t: Any, position: Any, velocity: Any, written: Callable[[Any], Any] = written) -> Any:
                return written(position[0])

            one = free.run(step, events=[vv.events.expression(near)], **asked).events
            other = free.run(step, events=[near], **asked).events
            assert len(one) >= len(other)
            if len(other):
                np.testing.assert_allclose(one.t, other.t, rtol=0.0, atol=1e-12)


def test_a_wave_is_sampled_where_a_free_body_takes_few_steps() -> None:
    free = vv.Scene(vv.Particles([1.0], [[0.0, 0.0, 0.0]], [[1.0, 0.0, 0.0]]), vv.LinearDrag(1e9))
    out = free.run(45.0, method="dop853", events=[vv.events.expression(lambda t, position, velocity: np.sin(t))])
    assert out.stats.steps < 45
    np.testing.assert_allclose(out.events.t, np.pi * np.arange(1, 15), rtol=1e-14)


def test_bodies_go_by_their_names() -> None:
    named = vv.events.expression(lambda t, x, v: x["b", 0] - x["star"][0])
    identical(planets().run(SPAN, events=[named]).events, planets().run(SPAN, events=EXPRESSIONS[:1]).events)
    with pytest.raises(vv.InvalidInput, match=r"events\[0\]: expected one of the bodies star, b, c, got 'd'"):
        planets().run(SPAN, events=[vv.events.expression(lambda t, x, v: x["d", 0])])


def test_spheres_that_bounce_and_merge() -> None:
    """What depends on velocities jumps where they meet; one of two bodies that are one is that of the whole."""
    position, velocity = [[-1.0, 0, 0], [1.0, 0, 0], [4.0, 1.0, 0]], [[1.0, 0, 0], [-1.0, 0, 0], [-1.5, 0, 0]]
    particles = vv.Particles([1.0, 1.0, 1.0], position, velocity, radius=0.2)
    scene = vv.Scene(particles, vv.UniformField([0.0, 0.1, 0.0]))

    def turned(t: Any, position: Any, velocity: Any) -> Any:
        return velocity[0, 0]

    def level(t: Any, position: Any, velocity: Any) -> Any:
        return position[1, 0] + position[2, 0] - 2.0

    some = scene.ensemble(position=particles.position + np.linspace(0.0, 0.1, 5)[:, None, None])
    for rule in ("bounce", "merge"):
        for asked in (scene, some):
            given: dict[str, Any] = {"method": "dop853", "collisions": rule}
            one = asked.run(3.0, events=[vv.events.expression(turned), vv.events.expression(level)], **given).events
            other = asked.run(3.0, events=[turned, level], **given).events
            assert len(other)
            assert np.array_equal(one.which, other.which)
            np.testing.assert_allclose(one.t, other.t, rtol=0.0, atol=1e-12)


def test_a_result_keeps_what_was_compiled(tmp_path: Path) -> None:
    out = planets().run(SPAN, events=EXPRESSIONS, method="dop853")
    out.save(tmp_path / "run.npz")
    kept: Any
    for kept in (pickle.loads(pickle.dumps(out)), vv.load(tmp_path / "run.npz")):
        assert kept.events == out.events
        assert kept.events.definitions == out.events.definitions
        assert dict(kept.events.definitions[0].parameters)["name"] == "transit"
        again = planets().run(SPAN, events=kept.events.definitions, method="dop853")
        assert again.events == out.events
    assert pickle.loads(pickle.dumps(EXPRESSIONS[0])) == EXPRESSIONS[0]


def test_it_may_look_at_nothing_but_the_time() -> None:
    out = kepler().run(5.0, method="dop853", events=[vv.events.expression(lambda t, x, v: t - 1.25)])
    np.testing.assert_allclose(out.events.t, [1.25], rtol=1e-15)
    assert not len(kepler().run(5.0, method="dop853", events=[vv.events.expression(lambda t, x, v: 1.0)]).events)


PYTHON = r"; a plain function f\(t, position, velocity\) in events= is asked in Python instead"


@pytest.mark.parametrize(
    ("function", "message"),
    [
        (lambda t, x, v: np.where(x[0, 0] > 0.0, 1.0, -1.0), f"has no truth value.*{PYTHON}"),
        (lambda t, x, v: np.maximum(x[0, 0], 0.0), f"maximum is bent.*{PYTHON}"),
        (lambda t, x, v: np.interp(x[0, 0], [0.0, 1.0], [0.0, 1.0]), f"{PYTHON}"),
        (lambda t, x, v: x[0], f"expected one number of the function.*{PYTHON}"),
        (lambda t, x, v: x[3, 0], r"index 3 is out of bounds.*positions and velocities are of shape \(2, 3\)"),
        (lambda q, v, t: q[0], r"expected a function f\(t, position, velocity\), in this order, got f\(q, v, t\)"),
        (lambda t, x, v, q, w: q[0], "got one that takes orientations"),
        (lambda t: t, r"the function is called with \(t, position, velocity\)"),
    ],
)
def test_what_is_no_expression_is_refused(function: Any, message: str) -> None:
    scene = kepler()
    for asked in (scene.run, scene.plan, scene.ensemble(mass=np.ones((2, 2))).run):
        with pytest.raises(vv.InvalidInput, match=rf"events\[1\]: .*{message}") as refused:
            asked(1.0, events=[vv.events.energy(0.5), vv.events.expression(function)])
        assert refused.value.argument == "events"


def test_expressions_of_sympy_are_refused() -> None:
    sp = pytest.importorskip("sympy")
    with pytest.raises(vv.InvalidInput, match=r"events\[0\]: expected a function .* got the expression x - 1 of SymPy"):
        kepler().run(1.0, events=[vv.events.expression(sp.Symbol("x") - 1)])


def _thin(width: float, place: float = 0.3) -> dict[str, Callable[..., Any]]:
    """Functions that are away from zero but within a width of a place."""
    return {
        "bump": lambda t, r, v: np.exp(-(((r[0, 0] - place) / width) ** 2)) - 0.5,
        "Lorentzian": lambda t, r, v: 1.0 / (1.0 + ((r[0, 0] - place) / width) ** 2) - 0.5,
        "sech": lambda t, r, v: 1.0 / np.cosh((r[0, 0] - place) / width) - 0.5,
        "box": lambda t, r, v: (
            np.tanh((r[0, 0] - place) / width + 3.0) - np.tanh((r[0, 0] - place) / width - 3.0) - 1.0
        ),
    }


@pytest.mark.parametrize("width", [1e-1, 1e-3, 1e-5])
@pytest.mark.parametrize("name", ["bump", "Lorentzian", "sech", "box"])
@pytest.mark.parametrize("how", [{}, {"method": "verner98"}, {"method": "leapfrog", "dt": 0.02}], ids=str)
def test_what_comes_and_goes_within_a_step_is_seen(how: dict[str, Any], name: str, width: float) -> None:
    """Of a free body, of which one step may be the whole run: it passes the place once, and the function zero twice."""
    body = vv.Scene(vv.Particles([1.0], [[-1.0, 0, 0]], [[0.3, 0, 0]]))
    out = body.run(t=20.0, events=[vv.events.expression(_thin(width)[name])], **how)
    assert len(out.events) == 2
    place = out.events.position[:, 0, 0] - 0.3
    # Both sides of the place, as far from it: to the rounding of places of about 1, times the run's roundings of time.
    assert place[0] < 0.0 < place[1]
    assert place.sum() == pytest.approx(0.0, rel=0.0, abs=1e-13)
    copies = body.ensemble(velocity=[[[0.3, 0, 0]], [[0.6, 0, 0]], [[-0.3, 0, 0]]])
    found = copies.run(t=20.0, events=[vv.events.expression(_thin(width)[name])], **how)
    assert np.bincount(found.events.member, minlength=3).tolist() == [2, 2, 0]


@pytest.mark.parametrize("rate", [20.0, 30.0, 40.0, 100.0, 1000.0])
def test_what_turns_fast_in_a_long_step_is_followed(rate: float) -> None:
    """A sine of the time, of a free body and on an ellipse: of 30 times π up to 600 there were 66 zeros, of 190."""
    zeros = int(20.0 * rate / np.pi)
    event = vv.events.expression(lambda t, r, v: np.sin(rate * t))
    free = vv.Scene(vv.Particles([1.0], [[-1.0, 0, 0]], [[0.3, 0, 0]]))
    for scene in (free, vv.problems.kepler(e=0.5).scene):
        found = scene.run(t=20.0, events=[event]).events.t
        assert len(found) == zeros
        # Some roundings of the time at the end.
        np.testing.assert_allclose(found, np.pi / rate * np.arange(1, zeros + 1), rtol=0.0, atol=1e-13)


def test_a_thin_function_ends_a_run() -> None:
    body = vv.Scene(vv.Particles([1.0], [[-1.0, 0, 0]], [[0.3, 0, 0]]))
    event = vv.events.expression(_thin(1e-4)["bump"], terminal=2)
    out = body.run(t=20.0, events=[event])
    assert out.status == vv.Status.STOPPED
    # Half of the top is √ln 2 widths after it.
    assert out.final.particles.position[0, 0] - 0.3 == pytest.approx(1e-4 * np.sqrt(np.log(2.0)), rel=0.0, abs=1e-13)
