"""Ready-made systems: that they are what they say, take what they are given, and need no SymPy.

Bounds: accelerations and momenta are sums of some ten products, 1e-14; motions in closed form to ten times the
roundings of their phases; a difference of order 8 with steps of 1e-3 divides roundings by that, 5e-14 and ten times
that is allowed.
"""

import inspect
import pickle
import subprocess
import sys
from typing import Any

import numpy as np
import pytest
import sympy as sp

import visviva as vv

ALL = list(vv.systems.__all__)


@pytest.mark.parametrize("name", ALL)
def test_a_system_runs_as_it_comes(name: str) -> None:
    function = getattr(vv.systems, name)
    system = function()
    out = system.run(t=np.linspace(0.0, 1.0, 5))
    assert out.status is vv.Status.OK
    assert np.isfinite(out.position).all()
    assert np.isfinite(out.energy).all()
    given = inspect.signature(function).parameters
    # Every parameter of the system is a keyword of the function (fields by their components), and has its default.
    for parameter, value in system.parameters.items():
        if parameter[0] in "EB" and len(parameter) == 2:
            continue
        if name == "central_force" and parameter == "k":
            continue
        assert given[parameter].default == value
        assert given[parameter].kind is inspect.Parameter.KEYWORD_ONLY
    second = "momentum" if isinstance(system, vv.Hamiltonian) else "velocity"
    assert {"position", second} <= set(given)
    again = pickle.loads(pickle.dumps(system))
    assert np.array_equal(again.run(1.0).position, system.run(1.0).position)


@pytest.mark.parametrize("name", ALL)
def test_a_system_shows_its_formula(name: str) -> None:
    system = vv.systems.chain(2) if name == "chain" else getattr(vv.systems, name)()
    if isinstance(system, vv.Hamiltonian):
        rates, forces = system.equations
        assert len(rates) == len(forces) == len(system.coordinates)
        return
    n = len(system.coordinates)
    velocities = [sp.Symbol(f"v_{coordinate}") for coordinate in system.coordinates]
    mass = system.mass_matrix
    assert mass.shape == (n, n)
    # p = M q̇ + what has no velocity.
    for i, momentum in enumerate(system.momenta):
        for j, velocity in enumerate(velocities):
            assert sp.simplify(momentum.diff(velocity) - mass[i, j]) == 0


def test_parameters_change_with_at_and_are_those_of_the_function() -> None:
    for name, changed in (
        ("pendulum", {"g": 1.6, "l": 2.0, "m": 3.0}),
        ("chain", {"g": 1.6, "l": 0.5, "m": 2.0}),
        ("swinging_atwood", {"counterweight": 2.5, "m": 0.7}),
        ("cart_pendulum", {"cart": 0.5, "l": 1.5}),
        ("moving_pivot", {"X": 0.1, "Y": 0.3, "Omega": 3.0}),
        ("coupled_oscillators", {"k": 2.0, "coupling": 0.5}),
    ):
        function: Any = getattr(vv.systems, name)
        there, here = function(**changed), function().at(parameters=changed)
        assert np.array_equal(there.run(2.0).position, here.run(2.0).position)
    fields = vv.systems.charged_particle(E=[0.1, 0.2, 0.3], B=[1.0, 2.0, 3.0])
    values = {"Ex": 0.1, "Ey": 0.2, "Ez": 0.3, "Bx": 1.0, "By": 2.0, "Bz": 3.0}
    assert {key: fields.parameters[key] for key in values} == values
    assert np.array_equal(
        vv.systems.charged_particle().at(parameters=values).run(2.0).position, fields.run(2.0).position
    )


def test_a_charge_feels_the_force_of_lorentz() -> None:
    rng = np.random.default_rng(2)
    E, B, r, v = rng.normal(size=(4, 3))
    charge = vv.systems.charged_particle(m=2.0, charge=-1.5, E=E, B=B, position=r, velocity=v)
    out = charge.run(1e-3 * np.arange(-4.0, 0.0)[::-1])
    ahead = charge.run(1e-3 * np.arange(1.0, 5.0))
    weights = np.array([4 / 5, -1 / 5, 4 / 105, -1 / 280])
    a = weights @ (ahead.velocity - out.velocity) / 1e-3
    assert a == pytest.approx(-1.5 / 2.0 * (E + np.cross(v, B)), rel=5e-13, abs=0)
    assert charge.momentum == pytest.approx(2.0 * v - 1.5 * np.cross(B, r) / 2, rel=1e-14, abs=0)


def test_moving_pivots_accelerations() -> None:
    g, l, X, Y, Omega = 9.81, 1.3, 0.2, 0.4, 2.5
    pivot = vv.systems.moving_pivot(l=l, X=X, Y=Y, Omega=Omega, position=[0.7], velocity=[0.2], m=3.0)
    for t in (0.0, 0.3, 1.1):
        x, y = -X * Omega**2 * np.cos(Omega * t), -Y * Omega**2 * np.sin(Omega * t)
        found = pivot._model.rates(np.array([t]), np.array([[0.7, 0.2]]), pivot._values[None, :])[0, 0]
        assert found == pytest.approx(-((g + y) * np.sin(0.7) + x * np.cos(0.7)) / l, rel=1e-14, abs=0)
    kapitza = vv.systems.kapitza(a=0.4, l=l, Omega=Omega, position=[0.7])
    found = kapitza._model.rates(np.array([0.3]), np.array([[0.7, 0.0]]), kapitza._values[None, :])[0, 0]
    y = -0.4 * Omega**2 * np.cos(Omega * 0.3)
    assert found == pytest.approx(-(g + y) * np.sin(0.7) / l, rel=1e-14, abs=0)


def test_kapitzas_pendulum_stands_where_it_should() -> None:
    """a² Ω² > 2 g l, to the first order of a/l."""
    limit = np.sqrt(2 * 9.81)
    T = np.linspace(0.0, 60.0, 601)
    for factor, stands in ((0.95, False), (1.05, True)):
        out = vv.systems.kapitza(a=0.02, Omega=factor * limit / 0.02, position=[np.pi - 0.01]).run(T)
        assert bool(np.abs(out["theta"] - np.pi).max() < 0.1) == stands


def test_coupled_oscillators_in_their_modes() -> None:
    n, k, coupling, m = 5, 2.0, 0.7, 1.5
    for j in range(n):
        mode = np.cos(np.pi * j * (np.arange(n) + 0.5) / n)
        omega = np.sqrt((k + 4 * coupling * np.sin(np.pi * j / (2 * n)) ** 2) / m)
        out = vv.systems.coupled_oscillators(n, k=k, coupling=coupling, m=m, position=mode).run(T := [1.0, 20.0])
        assert np.abs(out.position - np.cos(omega * np.array(T))[:, None] * mode).max() < 1e-13


def test_foucaults_plane_turns() -> None:
    rate = 0.3
    pendulum = vv.systems.foucault(g=4.0, l=1.0, Omega=rate / np.sin(0.7), latitude=0.7, position=[1.0, 0.0])
    out = pendulum.run(np.linspace(0.0, 20.0, 101))
    fast = np.sqrt(4.0 + rate**2)
    # z = x + iy in the frame that turns: the closed form of z'' + 2iΩ z' + ω² z = 0.
    z = np.exp(-1j * rate * out.t) * (np.cos(fast * out.t) + 1j * rate / fast * np.sin(fast * out.t))
    assert np.abs(out.position - np.stack([z.real, z.imag], axis=1)).max() < 1e-13


def test_swinging_atwood_is_integrable_for_three_to_one() -> None:
    """Tufillaro's second integral: r² θ̇ d/dt(…) of the mass ratio 3, in his form."""
    system = vv.systems.swinging_atwood(g=1.0, m=1.0, counterweight=3.0, position=[1.0, 1.0], velocity=[0.2, -0.1])
    out = system.run(np.linspace(0.0, 3.0, 31))
    r, theta = out.position.T
    v, w = out.velocity.T

    # N. B. Tufillaro, J. Physique 47, 1017 (1986): I = r² θ̇ [ṙ cos(θ/2) − (r θ̇/2) sin(θ/2)] + r² sin(θ/2) cos²(θ/2)
    def integral(sign: float) -> Any:
        s, c = np.sin(theta / 2), np.cos(theta / 2)
        return r**2 * w * (v * c - r * w / 2 * s) + sign * r**2 * s * c**2

    assert min(np.ptp(integral(sign)) for sign in (1.0, -1.0)) < 1e-14
    other = system.at(parameters={"counterweight": 2.5}).run(out.t)
    assert np.ptp(other.energy) < 1e-14


def test_potentials_of_central_forces() -> None:
    harmonic = vv.systems.central_force(lambda r, k: k * r**2 / 2, m=2.0, parameters={"k": 8.0}, velocity=[0.0, 0.5])
    out = harmonic.run(np.linspace(0.0, 5.0, 51))
    r, phi = out.position.T
    place = np.stack([r * np.cos(phi), r * np.sin(phi)], axis=1)
    wanted = np.stack([np.cos(2 * out.t), 0.25 * np.sin(2 * out.t)], axis=1)
    assert np.abs(place - wanted).max() < 1e-14
    assert vv.systems.central_force(parameters={"k": 2.0}).parameters == {"m": 1.0, "k": 2.0}


@pytest.mark.parametrize(
    ("call", "argument"),
    [
        (lambda: vv.systems.pendulum(m=0.0), "m"),
        (lambda: vv.systems.pendulum(l=-1.0), "l"),
        (lambda: vv.systems.pendulum(g=float("nan")), "g"),
        (lambda: vv.systems.pendulum(g="a"), "g"),
        (lambda: vv.systems.atwood(length=0.0), "length"),
        (lambda: vv.systems.cart_pendulum(cart=-1.0), "cart"),
        (lambda: vv.systems.swinging_atwood(counterweight=0.0), "counterweight"),
        (lambda: vv.systems.hoop(R=0.0), "R"),
        (lambda: vv.systems.chain(0), "n"),
        (lambda: vv.systems.chain(2.0), "n"),
        (lambda: vv.systems.chain(3, position=[0.1, 0.2]), "position"),
        (lambda: vv.systems.coupled_oscillators(0), "n"),
        (lambda: vv.systems.charged_particle(B=[1.0, 2.0]), "B"),
        (lambda: vv.systems.charged_particle(E=1.0), "E"),
        (lambda: vv.systems.central_force(3.0), "potential"),
        (lambda: vv.systems.central_force(lambda r, m: m * r, parameters={"m": 1.0}), "parameters"),
        (lambda: vv.systems.central_force(lambda r: r, parameters={"k": 1.0}), "potential"),
        (lambda: vv.systems.central_force(parameters=3.0), "parameters"),
        (lambda: vv.systems.henon_heiles(velocity=[0.0, 0.0]), "velocity"),
    ],
)
def test_bad_parameters_are_refused_by_their_names(call: Any, argument: str) -> None:
    with pytest.raises(vv.InvalidInput) as caught:
        call()
    assert caught.value.argument == argument


def test_no_system_needs_sympy() -> None:
    program = (
        "import sys; sys.modules['sympy'] = None\n"
        "import visviva as vv\n"
        "for name in vv.systems.__all__:\n"
        "    system = getattr(vv.systems, name)()\n"
        "    out = system.run(0.5)\n"
        "    out.energy, out.momentum, out.conservation(), str(system.plan(0.5)), repr(system)\n"
        "try:\n"
        "    vv.systems.pendulum().momenta\n"
        "except vv.InvalidInput as error:\n"
        "    print(error)\n"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert "pip install 'visviva[symbolic]'" in done.stdout
