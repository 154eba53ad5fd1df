"""Forces of one's own: what visviva has already, written as expressions, and what nobody else has.

Bounds: forces are a few products of numbers of size 1, 1e-14; a run in another frame parts by twenty roundings.
"""

import pickle
from typing import Any

import numpy as np
import pytest
import sympy as sp

import visviva as vv

x, y, z, vx, vy, vz, t = sp.symbols("x y z vx vy vz t", real=True)
k, q = sp.symbols("k q", positive=True)


def bodies(count: int = 5) -> vv.Particles:
    rng = np.random.default_rng(count)
    return vv.Particles(rng.uniform(0.5, 2.0, count), rng.normal(size=(count, 3)), rng.normal(size=(count, 3)))


def bowl(r: Any, v: Any, t: Any, k: Any) -> Any:
    return k * (r[0] ** 2 + r[1] ** 2 + r[2] ** 2) / 2


def turning(r: Any, v: Any, t: Any, q: Any) -> Any:
    return q * (0.5 * v[1] - 0.25 * v[2]), -0.5 * q * v[0], 0.25 * q * v[0]


# A force of visviva, the same of SymPy and of a function.
TWINS = {
    "oscillator": (
        vv.Harmonic(k=3.0),
        lambda: vv.ExpressionForce(potential=k * (x**2 + y**2 + z**2) / 2, parameters={k: 3.0}),
        lambda: vv.ExpressionForce(potential=bowl, parameters={"k": 3.0}),
    ),
    "magnetic field": (
        vv.UniformMagneticField([0.0, 0.25, 0.5], charge=2.0),
        lambda: vv.ExpressionForce(force=[q * (vy / 2 - vz / 4), -q * vx / 2, q * vx / 4], parameters={"q": 2.0}),
        lambda: vv.ExpressionForce(force=turning, parameters={"q": 2.0}),
    ),
    "central": (
        vv.CentralField(vv.potentials.Yukawa(k=-2.0, length=3.0)),
        lambda: vv.ExpressionForce(
            potential=-2 * sp.exp(-sp.sqrt(x**2 + y**2 + z**2) / 3) / sp.sqrt(x**2 + y**2 + z**2)
        ),
        lambda: vv.ExpressionForce(
            potential=lambda r, v, t: -2 * np.exp(-abs_of(r) / 3) / abs_of(r),
        ),
    ),
    "drive": (
        vv.DrivenForce([1.0, 0.0, 0.5], frequency=3.0, phase=0.25),
        lambda: vv.ExpressionForce(force=[sp.cos(3 * t + sp.Rational(1, 4)), 0, sp.cos(3 * t + 0.25) / 2]),
        lambda: vv.ExpressionForce(
            force=lambda r, v, t: (np.cos(3 * t + 0.25), 0.0, np.cos(3 * t + 0.25) / 2),
        ),
    ),
}


def abs_of(r: Any) -> Any:
    return np.sqrt(r[0] ** 2 + r[1] ** 2 + r[2] ** 2)


@pytest.mark.parametrize("method", [{"method": "dop853"}, {"method": "taylor"}, {"method": "rk4", "dt": 2.0**-9}])
@pytest.mark.parametrize("name", TWINS)
def test_what_there_is_moves_as_the_same_expression(name: str, method: dict[str, Any]) -> None:
    own, *expressions = TWINS[name]
    how = {"rtol": 1e-12, **method} if "dt" not in method else method
    if name == "central" and how["method"] == "taylor":
        # A field has no series of its own.
        how = {**how, "method": "dop853"}
    wanted = vv.Scene(bodies(), own, t0=0.5).run(t=2.5, **how)
    for make in expressions:
        scene = vv.Scene(bodies(), make(), t0=0.5)
        out = scene.run(t=2.5, **{**how, **method})
        # Two tolerances, on motions that magnify them some ten times.
        assert np.abs(out.position - wanted.position).max() < 1e-10
        assert np.abs(out.velocity - wanted.velocity).max() < 1e-10
    if name in ("oscillator", "central"):
        # As the places from which they come; measured 1.2e-12.
        assert np.allclose(out.potential_energy, wanted.potential_energy, rtol=1e-11, atol=0.0)
        assert np.ptp(out.energy) < 1e-10 * np.abs(out.kinetic_energy).max()


@pytest.mark.parametrize(
    "pulse", [lambda t: np.exp(-((t - 1.0) ** 2)), np.tanh, lambda t: 1.0 / (1.0 + t**2), lambda t: t**0.5]
)
def test_a_drive_that_may_not_have_begun_has_no_series(pulse: Any) -> None:
    """What begins more gently than any power is nothing in all coefficients."""
    force = vv.ExpressionForce(force=lambda r, v, t: (pulse(t), r[1], 0.0))
    with pytest.raises(vv.InvalidInput, match="of every force, and ExpressedForce with the time in it has none"):
        vv.Scene(bodies(), force).run(t=2.5, method="taylor")


def test_accelerations_are_those_of_the_formula() -> None:
    rng = np.random.default_rng(3)
    for count in (1, 2, 9, 40):
        mass, r, v = rng.uniform(0.5, 2.0, count), rng.normal(size=(count, 3)), rng.normal(size=(count, 3))
        force = vv.ExpressionForce(
            force=[k * sp.sin(x * y) - vz, sp.atan2(y, x) + t * vx, sp.tanh(z) * sp.sqrt(1 + vy**2)],
            parameters={k: 1.5},
        )
        found = vv.Scene(vv.Particles(mass, r, v), force, t0=0.75).acceleration()
        components = [
            1.5 * np.sin(r[:, 0] * r[:, 1]) - v[:, 2],
            np.arctan2(r[:, 1], r[:, 0]) + 0.75 * v[:, 0],
            np.tanh(r[:, 2]) * np.sqrt(1 + v[:, 1] ** 2),
        ]
        assert np.abs(found - np.stack(components, axis=1) / mass[:, None]).max() < 1e-14


def test_a_shifted_turned_and_rescaled_force_is_the_same() -> None:
    force = vv.ExpressionForce(potential=sp.cos(x + 2 * y) + z**4 + x**2)
    scene = vv.Scene(bodies(3), force, vv.Gravity(G=0.5))
    wanted = scene.run(t=1.0, rtol=1e-13)
    turn, _ = np.linalg.qr(np.random.default_rng(1).normal(size=(3, 3)))
    far = scene.shifted(position=[3.0, -2.0, 1.0]).rotated(turn).rescaled(length=2.0, mass=3.0, time=0.7)
    out = far.run(t=0.7, rtol=1e-13)
    back = ((out.position[-1] / 2.0) @ turn) - [3.0, -2.0, 1.0]
    assert np.abs(back - wanted.position[-1]).max() < 4e-14


@pytest.mark.parametrize(
    "units",
    [
        {"length": 1e-100, "mass": 1e-100, "time": 1e100},  # no force is left
        {"length": 1e100, "mass": 1e100, "time": 1e-100},  # nor is it a number
        {"time": 1e-200},  # whose square is none
        {"length": 1e200, "time": 1e-150, "mass": 1e-250},  # the force is, a speed is not
    ],
)
def test_units_in_which_nothing_is_left_are_refused(units: dict[str, float]) -> None:
    scene = vv.Scene(bodies(2), vv.ExpressionForce(potential=x**2 / 2))
    with pytest.raises(vv.InvalidInput, match=r"^length: expected units .* within float64"):
        scene.forces[0].rescaled(**units)
    # What differs as much and fits is taken.
    near = scene.rescaled(length=1e-100, mass=1e-100, time=1e-100)
    here = scene.run(t=1.0, rtol=1e-12).position[-1]
    assert np.abs(near.run(t=1e-100, rtol=1e-12).position[-1] * 1e100 - here).max() < 1e-9


def test_the_bits_are_the_same_alone_in_copies_and_with_threads() -> None:
    force = vv.ExpressionForce(force=lambda r, v, t: (np.sin(r[1]) - v[0], np.cos(t) * r[0], -(r[2] ** 3)))
    scene = vv.Scene(bodies(3), force, vv.Gravity(G=1.0, softening=0.1))
    starts = scene.particles.position + np.linspace(0.0, 1.0, 11)[:, None, None]
    for method in ({"method": "dop853"}, {"method": "rk4", "dt": 0.01}, {"method": "verner98"}):
        one, three = (scene.ensemble(position=starts).run(t=1.0, threads=n, **method) for n in (1, 3))
        assert np.array_equal(one.position, three.position)
        alone = vv.Scene(one[4].final.particles, *scene.forces)
        assert alone.forces == scene.forces
        for member in (0, 10):
            copy = vv.Scene(vv.Particles(scene.particles.mass, starts[member], scene.particles.velocity), *scene.forces)
            assert np.array_equal(copy.run(t=1.0, **method).position, one[member].position)


def test_files_and_pickles_hold_it(tmp_path: Any) -> None:
    force = vv.ExpressionForce(potential=k * x**2 * sp.exp(-(y**2)), parameters={"k": 0.1})
    assert pickle.loads(pickle.dumps(force)) == force
    assert hash(force) == hash(vv.ExpressionForce(potential=k * x**2 * sp.exp(-(y**2)), parameters={"k": 0.1}))
    out = vv.Scene(bodies(2), force).run(t=1.0)
    out.save(tmp_path / "run.npz")
    again = vv.load(tmp_path / "run.npz")
    assert again.scene.forces == (force,)
    assert np.array_equal(again.scene.run(t=1.0).position, out.position)


def test_what_leaves_the_domain_ends_there_with_what_was_computed() -> None:
    """Of x″ = −1/√x from rest at 1, x = 0 is reached at the time 4/3."""
    fall = vv.ExpressionForce(force=[-1 / sp.sqrt(x), 0, 0])
    with pytest.raises(vv.ConvergenceError) as caught:
        vv.Scene(vv.Particles([1.0], [[1.0, 0.0, 0.0]]), fall).run(t=[1.0, 10.0], rtol=1e-10)
    # Steps of a relative tolerance shrink to the end itself; measured 2.8e-12.
    assert abs(caught.value.time - 4 / 3) < 3e-11
    assert np.isfinite(caught.value.trajectory.position).all()


@pytest.mark.parametrize(
    ("make", "argument", "message"),
    [
        (vv.ExpressionForce, "potential", "one of potential, force and acceleration"),
        (
            lambda: vv.ExpressionForce(potential=x, force=[x, y, z]),
            "potential",
            "one of potential, force and acceleration",
        ),
        (lambda: vv.ExpressionForce(potential=k * x), "potential", "free symbol 'k' has no value"),
        (lambda: vv.ExpressionForce(potential=vx * x), "potential", "one of velocities; pass the force instead"),
        (lambda: vv.ExpressionForce(potential="x**2"), "potential", "expected a function or an expression"),
        (lambda: vv.ExpressionForce(potential=sp.Piecewise((x, x > 0), (0, True))), "potential", "switches"),
        (lambda: vv.ExpressionForce(potential=sp.besselj(0, x)), "potential", "not known"),
        (lambda: vv.ExpressionForce(force=[x, y]), "force", "three components"),
        (lambda: vv.ExpressionForce(force="xyz"), "force", "three components"),
        (lambda: vv.ExpressionForce(force=lambda r, v, t: (r[0], 0.0)), "force", "three components"),
        (lambda: vv.ExpressionForce(force=lambda r, v, t: 1.0), "force", "three components"),
        (lambda: vv.ExpressionForce(force=lambda r: r), "force", "called with"),
        (lambda: vv.ExpressionForce(potential=x, parameters={"x": 1.0}), "parameters", "names that are not x"),
        (lambda: vv.ExpressionForce(potential=k * x, parameters={k: "2"}), "parameters['k']", "number"),
        (lambda: vv.ExpressionForce(potential=k * x, parameters=[2.0]), "parameters", "values by parameter"),
        (lambda: vv.ExpressionForce(potential=k * x, parameters={k: np.nan}), "parameters['k']", "finite"),
        (lambda: vv.ExpressedForce("force", [3.0, 0.0], [], *np.eye(3)), "nodes", "ends too early"),
        (lambda: vv.ExpressedForce("force", [1.0, 0.0, 0.0, 1.0, 0.0], [], *np.eye(3)), "nodes", "expected 3"),
        (lambda: vv.ExpressedForce("potential", [1.0, 0.0, 99.0, 1.0, 0.0], [], *np.eye(3)), "nodes", "no such"),
        (lambda: vv.ExpressedForce("potential", [1.0, 0.0, 1.0, 9.0, 0.0], [], *np.eye(3)), "nodes", "not there"),
        (lambda: vv.ExpressedForce("potential", [1.0, 5.0, 1.0, 0.0, 0.0], [], *np.eye(3)), "nodes", "missing"),
        (lambda: vv.ExpressedForce("potential", [1.0, 0.0, 7.0, 0.0, 0.0], [], *np.eye(3)), "nodes", "argument"),
        (lambda: vv.ExpressedForce("potential", [1.0, 0.0, 1.0, 0.0, 0.0], [], *2 * np.eye(3)), "first", "length 1"),
    ],
)
def test_what_is_wrong_is_refused_by_name(make: Any, argument: str, message: str) -> None:
    def build() -> None:
        vv.Scene(vv.Particles([1.0], [[1.0, 0.0, 0.0]]), make()).plan(t=1.0)

    with pytest.raises(vv.InvalidInput, match=message) as caught:
        build()
    assert caught.value.argument == argument


def test_what_acts_by_its_force_needs_masses() -> None:
    with pytest.raises(vv.InvalidInput, match="every mass must be positive"):
        vv.Scene(vv.Particles([0.0], [[1.0, 0.0, 0.0]]), vv.ExpressionForce(potential=x)).run(t=1.0)


@pytest.mark.parametrize("count", [1, 9, 40])
def test_a_series_goes_over_no_turn_of_any_body(count: int) -> None:
    # V = sqrt(x²) pulls each by 1 towards x = 0, where that turns about: the first is there after sqrt(2 x).
    start = np.zeros((count, 3))
    start[:, 0] = np.linspace(2.0, 1.0, count) if count > 1 else 1.0
    scene = vv.Scene(vv.Particles(np.ones(count), start), vv.ExpressionForce(potential=sp.sqrt(x**2)))
    out = scene.run(t=1.4, method="taylor")
    assert np.abs(out.position[-1, :, 0] - (start[:, 0] - 1.4**2 / 2)).max() < 1e-15
    with pytest.raises(vv.Error):
        scene.run(t=2.1, method="taylor")
    ensemble = scene.ensemble(position=start[None] + np.zeros((3, 1, 1))).run(t=1.4, method="taylor")
    assert np.array_equal(ensemble.position[1, -1], out.position[-1])


@pytest.mark.parametrize("method", [{"method": "dop853"}, {"method": "taylor"}, {"method": "leapfrog", "dt": 2.0**-6}])
@pytest.mark.parametrize("count", [1, 3, 11])
def test_copies_with_parameters_of_their_own_move_as_alone(count: int, method: dict[str, Any]) -> None:
    trap = vv.ExpressionForce(potential=k * (x**2 + y**2) / 2 + q * (x**2 + z**2) ** 2, parameters={k: 2.0, q: 0.25})
    scene = vv.Scene(bodies(count), vv.UniformField([0.0, 0.0, -1.0]), trap)
    stiffness, quartic = np.linspace(0.5, 3.0, 13), np.linspace(1.0, 0.0, 13)
    out = scene.ensemble(parameters={trap: {"k": stiffness, "q": quartic}}).run(t=1.5, threads=2, **method)
    for copy in range(13):
        own = vv.ExpressionForce(
            potential=k * (x**2 + y**2) / 2 + q * (x**2 + z**2) ** 2,
            parameters={k: stiffness[copy], q: quartic[copy]},
        )
        alone = vv.Scene(bodies(count), vv.UniformField([0.0, 0.0, -1.0]), own).run(t=1.5, **method)
        assert np.array_equal(out.position[copy, -1], alone.position[-1])
        assert np.array_equal(out.energy[copy], alone.energy)


@pytest.mark.parametrize("name", ["c", "state", "own", "which", "force", "components"])
def test_a_parameter_may_have_any_name(name: str) -> None:
    drag = vv.ExpressionForce(
        force=lambda r, v, t, **own: tuple(-own[name] * component for component in v), parameters={name: 0.5}
    )
    alone = eval(f"lambda r, v, t, {name}: (-{name} * v[0], -{name} * v[1], -{name} * v[2])")
    of_name = vv.ExpressionForce(force=alone, parameters={name: 0.5})
    for force in (drag, of_name):
        found = vv.Scene(bodies(2), force).acceleration()
        np.testing.assert_allclose(found, -0.5 * bodies(2).velocity / bodies(2).mass[:, None], rtol=1e-15)
    with_default = vv.ExpressionForce(force=lambda r, v, t, c=2.0: (-c * v[0], -c * v[1], -c * v[2]))
    assert vv.Scene(bodies(2), with_default).acceleration().any()


def test_parameters_of_copies_are_asked_by_name() -> None:
    trap = vv.ExpressionForce(potential=k * x**2, parameters={k: 2.0})
    scene = vv.Scene(bodies(2), trap)
    for wrong, message in (
        ({"kk": [1.0]}, r"expected parameters of the expressions \['k'\], got 'kk'; did you mean 'k'"),
        ({"k": [[1.0, 2.0]]}, "expected one number 'k' for each copy"),
        ({"k": [np.nan]}, "copy 0"),
    ):
        with pytest.raises(vv.InvalidInput, match=message):
            scene.ensemble(parameters={trap: wrong})
    # By the name under which it was made, and by that of what it became.
    by_name = [scene.ensemble(parameters={name: {"k": [1.0, 3.0]}}) for name in ("ExpressionForce", "ExpressedForce")]
    assert by_name[0].forces == by_name[1].forces == scene.ensemble(parameters={trap: {"k": [1.0, 3.0]}}).forces
    with pytest.raises(vv.InvalidInput, match="several like that"):
        vv.Scene(bodies(2), trap, trap).ensemble(parameters={"ExpressionForce": {"k": [1.0]}})
    assert (
        pickle.loads(pickle.dumps(scene.ensemble(parameters={trap: {"k": [1.0, 3.0]}}))).forces[1][0].values[0] == 3.0
    )


@pytest.mark.parametrize(
    ("force", "shown"),
    [
        (vv.ExpressionForce(potential=bowl, parameters={"k": 2.0}), "potential=k*(x**2 + y**2 + z**2)/2, k=2.0"),
        (
            vv.ExpressionForce(force=[-k * x, vy, sp.sin(3 * t)], parameters={k: 2.0}),
            "force=(-k*x, vy, sin(3*t)), k=2.0",
        ),
        (vv.ExpressionForce(potential=sum(x**n / n for n in range(1, 20))), "potential=80 nodes"),
        (vv.ExpressionForce(potential=x).rescaled(length=2.0), "potential=x, length=2.0"),
        (
            vv.ExpressionForce(potential=x).shifted(np.array([1.0, 0, 0]), np.zeros(3)),
            "potential=x, origin=(1.0, 0.0, 0.0)",
        ),
    ],
)
def test_a_force_prints_as_its_formula(force: vv.forces.Force, shown: str) -> None:
    """And not as the table of numbers that it keeps."""
    assert repr(force) == f"ExpressedForce({shown})"
    assert shown in repr(vv.Scene(bodies(), force).forces)


def test_the_virial_beside_a_force_that_looks_at_velocities() -> None:
    """From positions alone it was that of bodies at rest: it is none, recorded or computed afterwards."""
    force = vv.ExpressionForce(force=lambda r, v, t: (-v[0], -v[1] - r[1], 0.0 * v[0]))
    scene = vv.Scene(vv.Particles([2.0], [[1.0, 2.0, 0.0]], [[3.0, 1.0, 0.0]]), force)
    recorded = scene.run(t=[0.0, 1.0], record=["position", "velocity", "virial"])
    for virial in (recorded.virial, scene.run(t=[0.0, 1.0]).virial, scene.invariants().virial):
        assert np.isnan(virial).all()
    still = vv.ExpressionForce(force=lambda r, v, t: (-r[0], -r[1], 0.0 * r[0]))
    out = vv.Scene(scene.particles, still).run(t=[0.0, 1.0])
    np.testing.assert_allclose(out.virial, -(out.position[:, 0] ** 2).sum(axis=-1), rtol=1e-14, atol=0)


class Compiled:
    """As Numba's: it takes numbers only, and has the function that it was made of."""

    def __init__(self, function: Any) -> None:
        self.py_func = function

    def __call__(self, *given: Any) -> Any:
        if not all(isinstance(each, float) for each in given):
            raise TypeError("cannot determine the type of an expression")
        return self.py_func(*given)


def test_functions_that_are_compiled_for_numbers() -> None:
    """They ended in an error of the compiler: the Python function has the expressions."""
    body = vv.Particles([2.0], [[1.0, 2.0, 0.0]], [[3.0, 1.0, 0.0]])
    written = vv.ExpressionForce(force=lambda r, v, t: (-r[0], -2 * r[1], -r[2]))
    compiled = vv.ExpressionForce(force=Compiled(lambda r, v, t: (-r[0], -2 * r[1], -r[2])))
    one, other = (vv.Scene(body, force).run(t=1.0).position for force in (written, compiled))
    np.testing.assert_array_equal(one, other)
    swing = vv.Lagrangian(Compiled(lambda q, v, t: v[0] ** 2 / 2 + np.cos(q[0])), ["x"], position=[0.1])
    assert swing.period() == pytest.approx(2 * np.pi, rel=1e-3, abs=0)


def test_rational_numbers_are_rounded_once() -> None:
    """SymPy's `complex` cuts them to some more digits first: one in forty small fractions was off by a last digit."""
    body = vv.Particles([1.0], [[0.3, 0.1, 0.2]])
    for p, q in [(1, 75), (1, 91), (2**57 + 1, 1), (10**40, 3), (-1, 10**300), (3**700, 7**400)]:
        force = vv.ExpressionForce(force=[sp.Rational(p, q), 0, 0])
        assert vv.Scene(body, force).acceleration()[0, 0] == p / q


def test_a_rational_number_beyond_floats_is_refused() -> None:
    with pytest.raises(vv.InvalidInput, match="expected finite real numbers"):
        vv.ExpressionForce(force=[sp.Rational(10**400, 3), 0, 0])


@pytest.mark.parametrize("method", ["auto", "taylor", "dop853", "rk4"])
@pytest.mark.parametrize(("mass", "length"), [(1e300, 1e100), (1e200, 1e120), (1e-200, 1e-130)])
def test_units_in_which_a_force_is_no_number_are_refused(method, mass, length):
    spring = vv.ExpressionForce(force=lambda r, v, t, k: (-k * r[0], -k * r[1], 0.0), parameters={"k": mass})
    scene = vv.Scene(vv.Particles([mass], [[length, 0.0, 0.0]], [[0.0, 0.5 * length, 0.0]]), [spring])
    step = {"dt": 0.1} if method == "rk4" else {}
    with pytest.raises(vv.InvalidInput, match="units in which what an ExpressionForce gives is a number"):
        scene.run(2.0, method=method, **step)
