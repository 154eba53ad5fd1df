"""Runs: the order of Gauss's methods and what they are, backward, going on, by every method of the registry.

Bounds: a run that goes on begins with a step of another length and parts by the error of steps, 2e-13 at most; those
of methods are their orders' errors times a constant of these systems, and 1e-7 of rtol = 1e-8; a longest step is kept
but for its rounding.
"""

import math
from typing import Any

import numpy as np
import pytest

import visviva as vv

GAUSS = {"gauss4": 2, "gauss8": 4, "gauss16": 8}


def states(out: Any) -> Any:
    return np.concatenate([out.position, out.velocity], axis=1)


def pade(s: int, z: complex) -> complex:
    """The diagonal Padé approximation of exp: what a method of Gauss makes of y' = λ y. Hairer & Wanner, IV.3."""

    def half(z: complex) -> complex:
        return sum(math.comb(s, j) * math.factorial(2 * s - j) * z**j / (math.factorial(2 * s)) for j in range(s + 1))

    return half(z) / half(-z)


@pytest.mark.parametrize("dt", [0.1, 0.5, 1.0, 2.0])
@pytest.mark.parametrize("method", GAUSS)
def test_gauss_turns_an_oscillator_by_pades_fraction(method: str, dt: float) -> None:
    """Every coefficient at once: a step is a turn whose size says the order, and no other number of it."""
    out = vv.systems.oscillator().run(10 * dt, method=method, dt=dt)
    found = out.position[-1, 0] - 1j * out.velocity[-1, 0]
    # Iterations of long steps end where rounding is some times larger than elsewhere.
    assert abs(found - pade(GAUSS[method], 1j * dt) ** 10) <= (1e-14 if dt < 2.0 else 1e-12)
    if dt == 2.0:
        return  # of the first order, iterations go with h and not with its square
    hamiltonian = vv.Hamiltonian(lambda q, p, _: p[0] ** 2 / 2 * 3 + q[0] ** 2 / 6, ["x"], position=[1.0])
    out = hamiltonian.run(10 * dt, method=method, dt=dt)
    found = out.position[-1, 0] - 3j * out.momentum[-1, 0]
    assert abs(found - pade(GAUSS[method], 1j * dt) ** 10) <= 1e-14


@pytest.mark.parametrize(("method", "dt", "ratio"), [("gauss4", 0.02, 2), ("gauss8", 0.1, 2), ("gauss16", 1.8, 9 / 7)])
def test_the_order_of_a_motion_that_is_not_linear(method: str, dt: float, ratio: float) -> None:
    end = 12.6 if method == "gauss16" else 4.0
    system = vv.systems.henon_heiles() if method == "gauss16" else vv.systems.spherical_pendulum()
    exact = states(system.run(end, rtol=1e-15))[-1]
    coarse, fine = (np.abs(states(system.run(end, method=method, dt=h))[-1] - exact).max() for h in (dt, dt / ratio))
    order = math.log(coarse / fine) / math.log(ratio)
    # Steps this long are not yet short: within a fifth of the order, of gauss16 within one.
    assert order == pytest.approx(2 * GAUSS[method], rel=0.2, abs=0), order


@pytest.mark.parametrize("method", [*GAUSS, "dop853", "rk4"])
@pytest.mark.parametrize("name", ["double_pendulum", "kapitza", "atwood", "charged_particle", "henon_heiles"])
def test_backward_is_where_it_came_from(name: str, method: str) -> None:
    system = getattr(vv.systems, name)()
    how = {"dt": 0.01} if method in ("gauss4", "gauss8", "rk4") else {"rtol": 1e-13}
    if name == "kapitza":
        system = system.at(parameters={"Omega": 8.0})
    out = system.run(2.0, method=method, **how)
    back = out.final.run([1.0, 0.0], method=method, **how)
    # Gauss's methods are symmetric; rk4 with 200 steps of 0.01 is no better than this.
    within = {"rk4": 3e-5, "dop853": 1e-10}.get(method, 1e-11)
    assert np.abs(states(back)[-1] - states(out)[0]).max() <= within
    assert list(back.t) == [1.0, 0.0]
    middle = system.run(1.0, method=method, **how)
    assert np.abs(states(back)[0] - states(middle)[-1]).max() <= within
    assert back.longest_step > 0.0


@pytest.mark.parametrize("name", ["double_pendulum", "kapitza", "charged_particle", "henon_heiles"])
def test_a_run_goes_on(name: str) -> None:
    system = getattr(vv.systems, name)()
    whole = system.run([1.0, 2.0])
    first = system.run(1.0).final
    assert first.t0 == 1.0
    second = first.run(2.0)
    assert list(second.t) == [1.0, 2.0]
    assert np.abs(states(second)[-1] - states(whole)[-1]).max() < 1e-11
    assert np.array_equal(states(second)[0], states(system.run(1.0))[-1])
    # Where it starts does not matter but for the time itself.
    still = system.run(0.0)
    assert np.array_equal(still.position[0], system.position)
    assert len(still) == 1


def test_a_start_far_from_zero_costs_the_digits_of_the_time_alone() -> None:
    pendulum = vv.systems.pendulum(position=[2.0])
    near, far = pendulum.run([1.0, 10.0]), pendulum.at(t0=2.0**30).run(2.0**30 + np.array([1.0, 10.0]))
    # The end is one of both; what is read on the way, where a time of 2^30 has its last digit.
    assert np.array_equal(states(near)[1], states(far)[1])
    assert np.abs(states(near) - states(far)).max() <= 2.0**-22 * 9.81
    driven = vv.systems.kapitza(Omega=2 * math.pi, position=[1.0])
    assert (
        np.abs(states(driven.run(3.0)) - states(driven.at(t0=2.0**20).run(2.0**20 + 3.0))).max() <= 1e-8
    )  # 2π is none: its rounding, 2e-16, by 2^20


# By methods of the registry: 0.3 of a motion in steps of 0.01; a coefficient of one is generous.
@pytest.mark.parametrize("name", [method.name for method in vv.methods()])
def test_every_method_of_the_registry(name: str) -> None:
    method = next(each for each in vv.methods() if each.name == name)
    how: dict[str, float] = {"rtol": 1e-8} if method.adaptive else {"dt": 0.01}
    times = [0.1234, 0.3]
    for system in (vv.systems.pendulum(g=1.0), vv.systems.henon_heiles()):
        exact = states(system.run(times))
        out = system.run(times, method=method, **how)
        assert np.abs(states(out) - exact).max() <= (1e-7 if method.adaptive else 0.3 * 0.01**method.order + 1e-14)
        assert out.method == name
        assert list(out.t) == times
    rotating = vv.systems.spherical_pendulum(g=1.0)
    if method.adaptive or "a" in method.coefficients:
        exact = states(rotating.run(times))
        found = states(rotating.run(times, method=name, **how))
        assert np.abs(found - exact).max() <= (1e-7 if method.adaptive else 3 * 0.01**method.order)
    else:
        with pytest.raises(vv.InvalidInput, match="accelerations that do not depend on velocities"):
            rotating.run(times, method=name, **how)


# Polynomials and what begins late: the first coefficients of all of these vanish.
DRIVES = {
    "t": (lambda t: t, lambda t: t**3 / 6),
    "t^4": (lambda t: t**4, lambda t: t**6 / 30),
    "t^9": (lambda t: t**9, lambda t: t**11 / 110),
    "1 + t^9": (lambda t: 1 + t**9, lambda t: t**2 / 2 + t**11 / 110),
    "sin t": (np.sin, lambda t: t - np.sin(t)),
    "t^30": (lambda t: (t / 2) ** 30, lambda t: 2**2 * (t / 2) ** 32 / 992),
    "late": (lambda t: np.exp(-50 * (t - 1.5) ** 2), lambda t: (t - 1.5) * math.sqrt(math.pi / 50)),
}


@pytest.mark.parametrize("method", ["taylor", "gauss16", "dop853"])
@pytest.mark.parametrize("name", DRIVES)
def test_what_drives_from_rest_is_seen(name: str, method: str) -> None:
    drive, exact = DRIVES[name]
    body = vv.Lagrangian(lambda q, v, t: v[0] ** 2 / 2 + drive(t) * q[0], ["x"], position=[0.0])
    out = body.run(3.0, method=method)
    # What is left of a Gaussian 1.5 from its middle is e^−112.
    assert abs(out.position[-1, 0] - exact(3.0)) <= 1e-10 * (1 + exact(3.0))
    many = body.ensemble(position=[[0.0], [1.0]]).run(3.0, method=method)
    assert np.array_equal(many.position[0], out.position)


@pytest.mark.parametrize("span", [20.0, 2000.0])
def test_a_wall_that_is_flat_to_all_orders_is_met(span: float) -> None:
    """Of V = x²⁰/20 all that a series of order 20 looks at vanishes in the middle."""
    billiard = vv.Lagrangian(lambda q, v, t: v[0] ** 2 / 2 - q[0] ** 20 / 20, ["x"], position=[0.0], velocity=[1.0])
    out = billiard.run(np.linspace(0.0, span, 201), method="taylor")
    assert np.abs(out["x"]).max() < 10.0**0.05 + 1e-9
    assert np.abs(out.energy - 0.5).max() < 1e-9
    many = billiard.ensemble(velocity=[[1.0], [0.0], [-2.0]]).run(np.linspace(0.0, span, 201), method="taylor")
    assert np.array_equal(many.position[0], out.position)
    assert not many.position[1].any()
    assert many.evaluations[0] == out.evaluations


@pytest.mark.parametrize("factor", [1.0, 3.0, np.sqrt(2.0)])
def test_a_valley_of_two_planes_is_crossed_where_it_bends(factor: float) -> None:
    """V = |c x|/c: from x = 1 down in √2, up in √2 on the other side, exactly parabolas."""
    valley = vv.Lagrangian(lambda q, v, t: v[0] ** 2 / 2 - abs(factor * q[0]) / factor, ["x"], position=[1.0])
    assert valley.plan(t=1.0).method == "dop853"
    assert valley.plan(t=1.0, dt=0.01).method == "gauss16"  # a step of one's own
    assert dict(valley.plan(t=1.0).rows)["kinks"].startswith("an absolute value")
    times = np.linspace(0.0, 12.0, 41)
    phase = times % (4.0 * np.sqrt(2.0))
    since = np.abs(
        (phase + np.sqrt(2.0)) % (2.0 * np.sqrt(2.0)) - np.sqrt(2.0)
    )  # since the last end of a swing, or to it
    side = np.where((phase > np.sqrt(2.0)) & (phase < 3.0 * np.sqrt(2.0)), -1.0, 1.0)
    out = valley.run(t=times)
    # A kink lies within a step that the tolerance, 1e-12, makes small: its square root is the time that it is off.
    assert np.abs(out.position[:, 0] - side * (1.0 - since**2 / 2.0)).max() < 1e-8
    copies = valley.ensemble(position=[[1.0], [0.5]]).run(t=times)
    assert (copies.position[0] == out.position).all()


@pytest.mark.parametrize(
    ("root", "power"),
    [
        (lambda x: (x**4) ** 0.25, 1.0),
        (lambda x: (3.0 * x * x) ** 0.5 / np.sqrt(3.0), 1.0),
        (lambda x: (x * x) ** 0.75, 1.5),
        (lambda x: (x**4) ** 0.625, 2.5),
    ],
)
def test_a_root_of_an_even_power_has_the_kink_of_an_absolute_value(root: Any, power: float) -> None:
    """The step made for smooth motions stood still there, or went over it: 1e-4 off at t = 1000, energy and all."""
    written = vv.Lagrangian(lambda q, v, t: v[0] ** 2 / 2 - root(q[0]), ["x"], position=[1.0])
    plain = vv.Lagrangian(lambda q, v, t: v[0] ** 2 / 2 - abs(q[0]) ** power, ["x"], position=[1.0])
    assert written.plan(t=1.0).method == "dop853"
    times = [5.0, 20.0, 100.0]
    one, other = written.run(times), plain.run(times)
    # Each passage costs a step's tolerance, which its square root makes of a time; measured 2e-8.
    assert np.allclose(one.position, other.position, rtol=0.0, atol=2e-7)
    with pytest.raises(vv.InvalidInput, match="where an absolute value turns"):
        written.run(1.0, method="gauss16")


def test_roots_that_have_no_kink_are_none() -> None:
    for function in (
        lambda q, v, t, k: v[0] ** 2 / 2 - np.sqrt(q[0] ** 2 + k),
        lambda q, v, t, k: v[0] ** 2 / 2 - abs(k) * q[0] ** 4,
        lambda q, v, t, k: v[0] ** 2 / 2 - k * np.sqrt(q[0] ** 4),
        lambda q, v, t, k: v[0] ** 2 / 2 - k * (q[0] ** 8) ** 0.25,
        lambda q, v, t, k: v[0] ** 2 / 2 - (1.0 + q[0] ** 2) ** 0.75,
        lambda q, v, t, k: v[0] ** 2 / 2 - ((1.0 + q[0] ** 2) ** 2) ** 0.75,
        lambda q, v, t, k: v[0] ** 2 / 2 - np.sqrt(np.cosh(q[0]) ** 2),
        lambda q, v, t, k: v[0] ** 2 / 2 - ((1.0 + t * t) ** 2) ** 0.25 * q[0] ** 2,
    ):
        smooth = vv.Lagrangian(function, ["x"], parameters={"k": 2.0}, position=[1.0])
        assert smooth.plan(t=1.0).method == "gauss16"
        assert "kinks" not in dict(smooth.plan(t=1.0).rows)


def test_a_longest_step_is_kept() -> None:
    for method in ("gauss16", "dop853", "taylor"):
        out = vv.systems.pendulum().run(10.0, method=method, max_step=0.05)
        assert out.longest_step <= 0.05 * (1 + 1e-13)
        assert out.steps >= 200
    held = vv.systems.pendulum().run(10.0, dt=0.05)
    assert held.steps == 200


def test_a_tighter_tolerance_does_better() -> None:
    system = vv.systems.double_pendulum(position=[0.5, 0.625])
    exact = states(system.run(10.0, rtol=1e-15))[-1]
    for method in ("gauss16", "dop853", "tsitouras54"):
        found = [np.abs(states(system.run(10.0, method=method, rtol=r))[-1] - exact).max() for r in (1e-4, 1e-7, 1e-10)]
        assert found[0] >= found[1] > found[2]
        assert all(error < 100 * rtol for error, rtol in zip(found, (1e-4, 1e-7, 1e-10), strict=True))


def test_the_plan_tells_what_will_run() -> None:
    plan = vv.systems.spherical_pendulum().plan(10.0)
    assert plan.method == "gauss16"
    assert plan.conserved == ("energy", "momentum of phi")
    text = str(plan)
    for words in ("theta, phi", "degrees of freedom", "does not enter", "diagonal", "held: energy is conserved"):
        assert words in text
    assert "enters" in str(vv.systems.kapitza().plan(1.0))
    assert "0.1, all alike" in str(vv.systems.pendulum().plan(1.0, method="rk4", dt=0.1))
    assert "1 constraint" in str(vv.systems.atwood().plan(1.0))
    with pytest.raises(vv.InvalidInput, match="did you mean"):
        vv.systems.pendulum().plan(1.0, method="gaus16")


def test_progress_is_told_and_may_interrupt() -> None:
    seen: list[tuple[int, int]] = []
    vv.systems.pendulum().ensemble(position=np.linspace(0.1, 1.0, 50)[:, None]).run(
        10.0, progress=lambda done, total: seen.append((done, total))
    )
    assert seen[-1] == (50, 50)


def test_outputs_may_be_one_time_a_list_or_the_start() -> None:
    pendulum = vv.systems.pendulum()
    assert list(pendulum.run(2).t) == [0.0, 2.0]
    assert list(pendulum.run([2]).t) == [2.0]
    assert list(pendulum.run(-2).t) == [0.0, -2.0]
    assert list(pendulum.run([0.0, 1.0]).t) == [0.0, 1.0]
    assert np.array_equal(pendulum.run([0.0, 1.0]).position[0], pendulum.position)
    assert np.array_equal(pendulum.run(2)["theta"], pendulum.run(2).position[:, 0])
    assert repr(pendulum.run(2)) == "GeneralizedTrajectory(theta; 2 times, t = 0 … 2, OK)"
    assert repr(pendulum) == "Lagrangian(theta; 3 parameters)"


@pytest.mark.parametrize("method", ["auto", "gauss16", "taylor", "dop853"])
@pytest.mark.parametrize("name", ["pendulum", "oscillator", "double_pendulum"])
def test_a_time_asked_for_twice_is_told_twice(name: str, method: str) -> None:
    """As in scenes: who puts lists of times together need not sort out what they share."""
    system = getattr(vv.systems, name)()
    once, twice = ([0.0, 1.0, 2.5], [0.0, 0.0, 1.0, 1.0, 1.0, 2.5, 2.5])
    rows = np.searchsorted(once, twice)
    several = system.ensemble(position=system.position + np.linspace(0.0, 0.1, 9)[:, None])
    assert states(system.run(twice, method=method)).tolist() == states(system.run(once, method=method))[rows].tolist()
    all_rows = several.run(once, method=method).position[:, rows]
    assert several.run(twice, method=method).position.tolist() == all_rows.tolist()


def test_coordinates_of_all_copies_by_their_names() -> None:
    runs = vv.systems.double_pendulum().ensemble(position=[[0.1, 0.2], [0.3, 0.4], [0.5, 0.6]]).run(t=[0.0, 0.5, 1.0])
    for index, name in enumerate(runs.ensemble.system.coordinates):
        np.testing.assert_array_equal(runs[name], runs.position[..., index])
        np.testing.assert_array_equal(runs[name][1], runs[1][name])
    with pytest.raises(vv.InvalidInput, match="there is no coordinate 'x'"):
        runs["x"]
