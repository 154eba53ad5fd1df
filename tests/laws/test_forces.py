"""Forces together: they add, each with its own parameters, and the conservation table says what they keep.

Bounds: sums of a few accelerations in another order, 1e-15; a run there and back, of a magnetic field alone, 1e-14;
runs at rtol = 1e-12 are ten times nearer than is allowed, in energy and to closed forms.
"""

from pathlib import Path

import numpy as np
import pytest

import visviva as vv

RNG = np.random.default_rng(20)


def cluster(n: int) -> vv.Particles:
    return vv.Particles(RNG.uniform(0.5, 2.0, n), RNG.normal(size=(n, 3)), RNG.normal(size=(n, 3)))


@pytest.mark.parametrize("n", [2, 3, 8, 9, 70])
def test_two_gravities_add(n: int) -> None:
    """Each has its own constant and softening: accelerations and energies are those of both."""
    bodies = cluster(n)
    one, other = vv.Gravity(G=1.0), vv.Gravity(G=3.0, softening=0.4)
    apart = [vv.Scene(bodies, force) for force in (one, other)]
    both = vv.Scene(bodies, one, other)
    # One rounding for the sum of the two.
    assert np.allclose(both.acceleration(), sum(scene.acceleration() for scene in apart), rtol=4e-16, atol=0)
    total = both.invariants().potential_energy
    assert total == pytest.approx(sum(scene.invariants().potential_energy for scene in apart), rel=4e-16, abs=0)


def test_two_gravities_are_one_of_the_summed_constant() -> None:
    bodies = cluster(3)
    both = vv.Scene(bodies, vv.Gravity(1.0), vv.Gravity(3.0)).run(t=0.1, method="dop853", rtol=1e-12)
    one = vv.Scene(bodies, vv.Gravity(4.0)).run(t=0.1, method="dop853", rtol=1e-12)
    # Two runs, each within rtol of the motion, which here magnifies little.
    assert np.allclose(both.position, one.position, rtol=0, atol=1e-11)
    assert "2 forces between them" in str(both.plan)


@pytest.mark.parametrize("method", ["auto", "leapfrog"])
def test_two_gravities_for_two_bodies(method: str) -> None:
    """No closed form may take the constant of the first for that of both."""
    pair = vv.Particles([1.0, 1.0], [[-0.5, 0, 0], [0.5, 0, 0]], [[0, -1.0, 0], [0, 1.0, 0]])
    how = {} if method == "auto" else {"method": method, "dt": 1e-3}
    out = vv.Scene(pair, vv.Gravity(1.0), vv.Gravity(1.0)).run(t=[0.0, 0.5, 1.0], **how)
    # A circle: v² = G m / (2 r) of each about the center, 1 = 2 · 1 · 1/(4 · 0.5). Leapfrog's dt² phase error is 1e-7.
    assert np.allclose(np.linalg.norm(out.position, axis=-1), 0.5, rtol=0, atol=1e-6)


def test_two_uniform_and_two_central_fields_add() -> None:
    bodies = cluster(4)
    forces = [
        vv.UniformField([1.0, 0.0, 2.0]),
        vv.UniformField([0.0, -3.0, 0.5]),
        vv.CentralField(vv.potentials.Coulomb(-1.0), [5.0, 0.0, 0.0]),
        vv.CentralField(vv.potentials.Coulomb(-2.0), [0.0, 6.0, 0.0]),
    ]
    both = vv.Scene(bodies, *forces)
    apart = [vv.Scene(bodies, force) for force in forces]
    assert np.allclose(both.acceleration(), sum(scene.acceleration() for scene in apart), rtol=1e-15, atol=1e-15)
    energies = [scene.invariants().potential_energy for scene in apart]
    assert both.invariants().potential_energy == pytest.approx(sum(energies), rel=1e-15, abs=0)


def test_a_force_that_does_nothing_keeps_everything() -> None:
    out = vv.Scene(cluster(2), vv.Gravity(1.0, softening=1.0), vv.UniformField([0.0, 0.0, 0.0])).run(t=0.5)
    assert all(row.conserved for row in out.conservation().rows)


def test_two_centers_keep_no_angular_momentum() -> None:
    forces = [vv.CentralField(vv.potentials.Coulomb(-1.0), [x, 0.0, 0.0]) for x in (-1.0, 1.0)]
    body = vv.Particles([1.0], [[0.0, 1.0, 0.0]], [[0.5, 0.0, 0.0]])
    table = vv.Scene(body, *forces).run(t=[0.0, 0.5, 1.0]).conservation(about=[1.0, 0.0, 0.0])
    assert not table.angular_momentum.conserved
    assert table.energy.conserved


BY_NAME = {method.name: method for method in vv.methods()}
ONE = vv.Particles([2.0], [[1.0, -0.5, 0.25]], [[0.5, 1.0, -2.0]])


def test_drag_decays() -> None:
    tau, t = 0.7, np.linspace(0.0, 2.0, 5)
    out = vv.Scene(ONE, vv.LinearDrag(tau)).run(t=t, rtol=1e-12)
    decay = np.exp(-t / tau)[:, None]
    # rtol of what the motion covers, 2 or less.
    assert np.allclose(out.velocity[:, 0], ONE.velocity[0] * decay, rtol=0, atol=1e-11)
    assert np.allclose(out.position[:, 0], ONE.position[0] + ONE.velocity[0] * tau * (1 - decay), rtol=0, atol=1e-11)
    assert not any(row.conserved for row in out.conservation().rows)


def test_a_charge_circles_and_keeps_its_energy() -> None:
    """Angular frequency −q B / m about B; the kinetic energy is kept, and the table says so."""
    charge, field, t = 1.5, 2.0, np.linspace(0.0, 10.0, 6)
    out = vv.Scene(ONE, vv.UniformMagneticField([0.0, 0.0, field], charge)).run(t=t, rtol=1e-12)
    angle = -charge * field / 2.0 * t
    v = ONE.velocity[0]
    # 15 rad at rtol 1e-12 of velocities of 2, some hundred steps.
    assert np.allclose(out.velocity[:, 0, 0], v[0] * np.cos(angle) - v[1] * np.sin(angle), rtol=0, atol=1e-10)
    assert np.allclose(out.velocity[:, 0, 1], v[0] * np.sin(angle) + v[1] * np.cos(angle), rtol=0, atol=1e-10)
    assert np.allclose(out.velocity[:, 0, 2], v[2], rtol=0, atol=1e-12)
    table = out.conservation()
    assert [row.conserved for row in table.rows] == [True, False, False, False]
    assert table.energy.max < 1e-10


def test_every_body_has_its_own_charge() -> None:
    bodies = vv.Particles([1.0, 2.0, 0.0], np.eye(3), [[1.0, 0.0, 0.0]] * 3)
    a = vv.Scene(bodies, vv.UniformMagneticField([0.0, 0.0, 3.0], [1.0, -4.0, 0.0])).acceleration()
    assert a.tolist() == [[0.0, -3.0, 0.0], [0.0, 6.0, 0.0], [0.0, 0.0, 0.0]]


@pytest.mark.parametrize("t0", [0.0, 2.5, 1e15, -1e12])
def test_a_drive_starts_at_its_phase(t0: float) -> None:
    """x(t) = x0 + v0 s + A/(m w²) (cos φ0 − cos(w s + φ0) − w s sin φ0), φ0 = w t0 + phase to thirty digits."""
    import mpmath

    frequency, phase, amplitude, s = 0.75, 0.3, 3.0, 4.0
    body = vv.Particles([2.0], [[0.0, 0.0, 0.0]])
    out = vv.Scene(body, vv.DrivenForce([amplitude, 0.0, 0.0], frequency, phase), t0=t0).run(
        t=t0 + s, rtol=1e-12, method="dop853"
    )
    with mpmath.workdps(40):
        start = mpmath.mpf(frequency) * mpmath.mpf(t0) + mpmath.mpf(phase)
        end = start + frequency * s
        expected = float(
            amplitude / 2.0 / frequency**2 * (mpmath.cos(start) - mpmath.cos(end) - frequency * s * mpmath.sin(start))
        )
    assert out.position[-1, 0, 0] == pytest.approx(expected, abs=1e-10)
    assert not any(row.conserved for row in out.conservation().rows)


def test_a_spring_and_gravity_add() -> None:
    bodies = cluster(12)
    forces = vv.Gravity(1.0), vv.Spring([0, 3], [11, 4], k=2.0, length=0.5)
    apart = [vv.Scene(bodies, force).acceleration() for force in forces]
    assert np.allclose(vv.Scene(bodies, *forces).acceleration(), apart[0] + apart[1], rtol=1e-15, atol=1e-15)


TURNING = ("boris", "boris4")  # which take what turns velocities
WITHOUT = [name for name, method in BY_NAME.items() if (method.symplectic or "stormer" in name) and name not in TURNING]


@pytest.mark.parametrize("method", WITHOUT)
@pytest.mark.parametrize("force", [vv.LinearDrag(1.0), vv.UniformMagneticField([0.0, 0.0, 1.0])], ids=repr)
def test_a_method_without_velocities_refuses_a_force_that_looks_at_them(method: str, force: vv.forces.Force) -> None:
    with pytest.raises(vv.InvalidInput, match=rf"{type(force).__name__}.*rk4, .*dop853") as caught:
        vv.Scene(ONE, force).run(t=1.0, method=method, dt=0.1)
    assert caught.value.argument == "method"


@pytest.mark.parametrize("method", TURNING)
def test_a_method_that_turns_velocities_takes_nothing_else_that_looks_at_them(method: str) -> None:
    with pytest.raises(vv.InvalidInput, match=rf"{method} cannot take LinearDrag.*rk4, .*verner98") as caught:
        vv.Scene(ONE, vv.LinearDrag(1.0)).run(t=1.0, method=method, dt=0.1)
    assert caught.value.argument == "method"
    with pytest.raises(vv.InvalidInput, match=r"expected one of euler.*boris, boris4"):
        vv.Scene(ONE, vv.UniformMagneticField([0.0, 0.0, 1.0])).plan(t=1.0, method="leapfrog", dt=0.1)


@pytest.mark.parametrize("method", [name for name, method in BY_NAME.items() if not method.adaptive])
def test_a_driven_force_is_felt_at_the_times_of_its_kicks(method: str) -> None:
    """Each halving of the step leaves 2⁻ᵖ of the error, at an angle of the drive that is none of the start's."""
    start = vv.Particles([1.0], [[1.0, 0.0, 0.0]], [[0.0, 0.7, 0.1]])
    field = vv.CentralField(vv.potentials.Yukawa(k=-2.0, length=1.5))
    scene = vv.Scene(start, field, vv.DrivenForce([0.5, 0.0, 0.2], 3.0, 0.3), t0=2.0)
    exact = scene.run(t=3.0, method="verner98", rtol=1e-13).position[-1]
    errors = [np.abs(scene.run(t=3.0, method=method, dt=dt).position[-1] - exact).max() for dt in (1 / 64, 1 / 128)]
    # Worst: 1.04, at order 1; the reference is known to 7e-15. What starts a multistep method has its dense order.
    assert errors[1] < 1.1 * errors[0] / 2.0 ** BY_NAME[method].dense_order + 2e-14
    assert errors[0] < 0.1


@pytest.mark.parametrize(
    ("force", "argument"),
    [
        (lambda: vv.LinearDrag(0.0), "tau"),
        (lambda: vv.UniformMagneticField([0, 0, 1.0], [1.0, 0.0, 3.0]), "charge"),
        (lambda: vv.UniformMagneticField([0, 0, 1.0], [0.0, 1.0]), "mass"),
        (lambda: vv.DrivenForce([1.0, 0, 0], 1.0), "mass"),
        (lambda: vv.Spring(0, 2, 1.0), "j"),
        (lambda: vv.Spring(0, 0, 1.0), "j"),
        (lambda: vv.Spring(-1, 0, 1.0), "i"),
        (lambda: vv.Spring(0, 1, -1.0), "k"),
        (lambda: vv.Spring([0, 1], [1, 0], [1.0, 1.0, 1.0]), "i"),
        (lambda: vv.Spring(0, 1, 1.0), "mass"),
        (lambda: vv.Harmonic(-1.0), "k"),
        (lambda: vv.Harmonic(1.0), "mass"),
        (lambda: vv.QuadraticDrag(-1.0), "coefficient"),
        (lambda: vv.QuadraticDrag([1.0, 0.0, 1.0]), "coefficient"),
        (lambda: vv.QuadraticDrag([0.0, 1.0]), "mass"),
        (lambda: vv.UniformElectricField([0, 0, 1.0], [1.0, 0.0, 3.0]), "charge"),
        (lambda: vv.UniformElectricField([0, 0, 1.0]), "mass"),
        (lambda: vv.Coulomb([1.0, 0.0, 1.0], k=1.0), "charge"),
        (lambda: vv.Coulomb([1.0, 1.0], k=1.0), "mass"),
        (lambda: vv.Coulomb([1.0, 0.0], k=1.0, softening=-1.0), "softening"),
        (lambda: vv.Damper(0, 2, 1.0), "j"),
        (lambda: vv.Damper(0, 0, 1.0), "j"),
        (lambda: vv.Damper(0, 1, -1.0), "c"),
        (lambda: vv.Damper([0, 1], [1, 0], [1.0, 1.0, 1.0]), "i"),
        (lambda: vv.Damper(0, 1, 1.0), "mass"),
    ],
)
def test_forces_refuse_by_name(force: object, argument: str) -> None:
    bodies = vv.Particles([1.0, 0.0], [[0.0, 0, 0], [1.0, 0, 0]])
    with pytest.raises(vv.InvalidInput) as caught:
        vv.Scene(bodies, force()).plan(t=1.0)  # type: ignore[operator]
    assert caught.value.argument == argument


@pytest.mark.parametrize("link", [lambda *ends: vv.Spring(*ends, k=1.0), lambda *ends: vv.Damper(*ends, c=1.0)])
def test_an_anchor_is_no_body(link: object) -> None:
    """Who gives a place for an end is told what leads to one."""
    with pytest.raises(vv.InvalidInput, match=r"are bodies by index or name: to a fixed place leads Harmonic"):
        link(0, [0, 0, 0])  # type: ignore[operator]


def test_coincident_ends_of_a_spring_with_a_length_are_refused() -> None:
    bodies = vv.Particles([1.0, 1.0], np.zeros((2, 3)))
    with pytest.raises(vv.InvalidInput, match="distinct ends"):
        vv.Scene(bodies, vv.Spring(0, 1, 1.0, 0.5)).run(t=1.0)
    assert vv.Scene(bodies, vv.Spring(0, 1, 1.0)).run(t=1.0).position[-1].tolist() == np.zeros((2, 3)).tolist()


@pytest.mark.parametrize(
    "force",
    [
        vv.LinearDrag(0.7),
        vv.UniformMagneticField([0.3, -0.4, 1.0], [1.0, -2.0, 0.5]),
        vv.DrivenForce([1.0, -2.0, 0.5], 3.0, 0.2),
        vv.Spring([0, 1], [1, 2], [1.0, 2.0], 0.3),
        vv.Harmonic(2.0, [0.5, -1.0, 2.0]),
        vv.QuadraticDrag([1.0, 0.5, 0.0]),
        vv.Drag(1.5, 0.25, [1.0, 0.5, 0.0]),
        vv.drag.custom(lambda R: 20.0 / R + 1.0, 0.5, 64.0, density=1.5, viscosity=0.25, radius=[1.0, 0.5, 0.0]),
        vv.UniformElectricField([0.3, -0.4, 1.0], [1.0, -2.0, 0.5]),
        vv.RotatingFrame([0.3, -0.4, 1.0], [0.5, -1.0, 2.0]),
        vv.Damper([0, 1], [1, 2], [1.0, 2.0]),
        vv.Coulomb([1.0, -2.0, 0.5], k=3.0, softening=0.2),
        vv.Oblate(1, 1.5, 0.1, 0.4, [0.3, -0.4, 1.0], 0.05),
        vv.PostNewtonian(1, 1.5, 7.0),
    ],
    ids=repr,
)
def test_a_force_turns_and_changes_units_with_the_scene(force: vv.forces.Force) -> None:
    rng = np.random.default_rng(3)
    scene = vv.Scene(vv.Particles([1.0, 2.0, 3.0], rng.normal(size=(3, 3)), rng.normal(size=(3, 3))), force, t0=0.4)
    a = scene.acceleration()
    turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    for matrix in (turn, -turn):  # one of them reflects
        # A few roundings of numbers of size 10.
        assert np.allclose(scene.rotated(matrix).acceleration(), a @ matrix.T, rtol=0, atol=1e-14)
    new = scene.rescaled(length=1.7, mass=0.3, time=2.9).acceleration()
    assert np.allclose(new, a * 1.7 / 2.9**2, rtol=1e-13, atol=1e-15)
    back = scene.rescaled(length=2.0**7, mass=2.0**-3, time=2.0**5).rescaled(length=2.0**-7, mass=2.0**3, time=2.0**-5)
    assert back == scene


def test_a_charge_retraces_its_path_and_drag_does_not() -> None:
    scene = vv.Scene(ONE, vv.UniformMagneticField([0.3, 0.0, 1.0]))
    there = scene.run(t=3.0, rtol=1e-12).final.reversed()
    back = there.run(t=there.t0 + 3.0, rtol=1e-12).final
    assert np.allclose(back.particles.position, ONE.position, rtol=0, atol=1e-14)
    drags = vv.LinearDrag(1.0), vv.QuadraticDrag(1.0), vv.Drag(1.0, 1.0, 1.0)
    irreversible = *drags, vv.Damper(0, 1, 1.0), vv.DrivenForce([1.0, 0, 0], 1.0)
    for force in irreversible:
        with pytest.raises(vv.InvalidInput, match="cannot be reversed"):
            vv.Scene(ONE, force).reversed()
    resting = *drags, vv.UniformMagneticField([0.0, 0.0, 1.0]), vv.Harmonic(1.0)
    for force in (*resting, vv.RotatingFrame([0.0, 0.0, 1.0])):
        with pytest.raises(vv.InvalidInput, match="boosted"):
            vv.Scene(ONE, force).in_frame(velocity=[1.0, 0.0, 0.0])


def test_a_rotating_frame_sees_what_is_at_rest_outside() -> None:
    """x = R(−ωt) of what it is outside, for any motion there; by the closed form and step by step."""
    omega, center = np.array([0.3, -0.5, 0.8]), np.array([1.0, 0.5, -2.0])
    x0, v0 = np.array([2.0, 1.0, 0.0]), np.array([0.3, 0.2, -0.7])  # outside
    t, size = 7.0, np.linalg.norm(omega)
    from scipy.spatial.transform import Rotation

    turn = Rotation.from_rotvec(-omega * t)
    expected = center + turn.apply(x0 + v0 * t - center)
    scene = vv.Scene(vv.Particles([0.0], [x0], [v0 - np.cross(omega, x0 - center)]), vv.RotatingFrame(omega, center))
    exact = scene.run(t=t)
    assert exact.plan.solution == "closed form: straight lines seen from a rotating frame"
    # Roundings of this line and of scipy's rotation by 7 rad.
    np.testing.assert_allclose(exact.position[-1, 0], expected, rtol=0, atol=1e-14)
    speed = turn.apply(v0) - np.cross(omega, expected - center)
    np.testing.assert_allclose(exact.velocity[-1, 0], speed, rtol=0, atol=1e-14)
    stepped = scene.run(t=t, method="dop853", rtol=1e-12)
    np.testing.assert_allclose(stepped.position[-1, 0], expected, rtol=0, atol=1e-10 * (1 + size * t))


def test_a_rotating_frame_keeps_jacobis_integral() -> None:
    """The restricted three-body problem with both stars at rest in the frame; L4 stays, a reversed path returns."""
    mu = 0.1
    stars = [
        vv.CentralField(vv.potentials.Coulomb(-(1 - mu)), [-mu, 0.0, 0.0]),
        vv.CentralField(vv.potentials.Coulomb(-mu), [1 - mu, 0.0, 0.0]),
    ]
    planet = vv.Particles([1.0], [[0.2, 0.9, 0.1]], [[0.1, -0.2, 0.05]])
    scene = vv.Scene(planet, vv.RotatingFrame([0, 0, 1.0]), *stars)
    out = scene.run(t=np.linspace(0, 10, 21), rtol=1e-12)
    x, v = out.position[:, 0], out.velocity[:, 0]
    r1, r2 = np.linalg.norm(x - [-mu, 0, 0], axis=1), np.linalg.norm(x - [1 - mu, 0, 0], axis=1)
    jacobi = 0.5 * (v**2).sum(1) - 0.5 * (x[:, 0] ** 2 + x[:, 1] ** 2) - (1 - mu) / r1 - mu / r2
    np.testing.assert_allclose(out.energy, jacobi, rtol=0, atol=4e-15)
    table = out.conservation()
    assert [row.conserved for row in table.rows] == [True, False, False, False]
    assert table.energy.max < 5e-13
    fourth = vv.Particles([1.0], [[0.5 - mu, np.sqrt(3) / 2, 0.0]])
    # The rounding of the place, 1e-16, grows as e^{0.6 t} at this mass ratio.
    there = vv.Scene(fourth, *scene.forces).run(t=5.0, rtol=1e-12).position[-1]
    np.testing.assert_allclose(there, fourth.position, rtol=0, atol=1e-12)
    back = out.final.reversed()
    again = back.run(t=back.t0 + 10.0, rtol=1e-12).final
    np.testing.assert_allclose(again.particles.position, planet.position, rtol=0, atol=1e-7)


def test_electric_fields_pull_each_charge_by_its_own() -> None:
    bodies = vv.Particles([1.0, 2.0, 0.0], np.eye(3), [[1.0, 0.0, 0.0]] * 3)
    scene = vv.Scene(bodies, vv.UniformElectricField([0.0, 3.0, 1.0], [1.0, -4.0, 0.0]))
    assert scene.acceleration().tolist() == [[0.0, 3.0, 1.0], [0.0, -6.0, -2.0], [0.0, 0.0, 0.0]]
    assert scene.run(t=2.0).position[-1].tolist() == [[3.0, 6.0, 2.0], [2.0, -11.0, -4.0], [2.0, 0.0, 1.0]]
    assert scene.run(t=2.0, method="leapfrog", dt=0.5).position[-1].tolist() == scene.run(t=2.0).position[-1].tolist()
    both = vv.Scene(bodies, *scene.forces, vv.LinearDrag(0.5)).run(t=2.0)
    assert both.plan.solution == "closed form: exponential decay"
    stepped = vv.Scene(bodies, *scene.forces, vv.LinearDrag(0.5)).run(t=2.0, method="dop853", rtol=1e-12)
    np.testing.assert_allclose(both.position, stepped.position, rtol=0, atol=1e-12)


@pytest.mark.parametrize("how", [{}, {"method": "leapfrog", "dt": 0.005}], ids=repr)
@pytest.mark.parametrize(
    "force",
    [vv.UniformElectricField([1.0, 0.0, 0.5], [0.0, 1.0, -3.0]), vv.Coulomb([0.0, 1.0, -3.0], k=2.0)],
    ids=repr,
)
def test_energies_of_charges_that_a_massless_body_precedes(force: vv.forces.Force, how: dict[str, object]) -> None:
    """What is integrated apart, or in another order, must not take the charge of another."""
    bodies = vv.Particles(
        [0.0, 1.0, 2.0], [[5, 0, 0], [1.0, 0, 0], [-1, 0, 0.5]], [[0, 0.2, 0], [0, 0.5, 0], [0, -0.3, 0]]
    )
    scene = vv.Scene(bodies, vv.Gravity(1.0), force)
    out = scene.run(t=[0, 0.5, 1.0], record=("position", "velocity", "energy"), **how)  # type: ignore[arg-type]
    for row in range(3):
        now = vv.Scene(vv.Particles(bodies.mass, out.position[row], out.velocity[row]), *scene.forces)
        # The rounding of the recorded state.
        assert out.energy[row] == pytest.approx(now.invariants().energy, rel=1e-14, abs=0)
    end = scene.run(t=1.0, events=[vv.events.energy(scene.invariants().energy + 1.0)], **how)  # type: ignore[arg-type]
    assert len(end.events) == 0


def test_a_drive_beyond_what_its_cosine_knows_is_refused() -> None:
    body = vv.Particles([1.0], [[0.0, 0.0, 0.0]])
    drive = vv.DrivenForce([1.0, 0.0, 0.0], frequency=1e10)
    near = vv.Scene(body, drive, t0=3.4e5)
    assert np.isfinite(near.acceleration()).all()
    assert abs(near.acceleration()[0, 0]) <= 1.0
    for ask in (
        lambda: vv.Scene(body, drive, t0=-3.6e5).acceleration(),
        lambda: near.run(3.6e5, method="rk4", dt=1e4),
        lambda: near.ensemble(parameters={0: {"frequency": [1.0, 1e10]}}).run(3.6e5, method="taylor"),
    ):
        with pytest.raises(vv.InvalidInput, match="DrivenForce is known for angles") as refused:
            ask()
        assert refused.value.argument == "frequency"
    # A closed form knows larger ones.
    assert near.run(3.6e5).plan.closed_form


def test_an_array_of_one_number_is_the_number(tmp_path: Path) -> None:
    """Which means the same to the core, and files give the number back: scenes of one body were not what they were."""
    for array, number in (
        (vv.QuadraticDrag([0.1]), vv.QuadraticDrag(0.1)),
        (vv.Coulomb([2.0], k=1.0), vv.Coulomb(2.0, k=1.0)),
    ):
        assert array == number
        assert hash(array) == hash(number)
        out = vv.Scene(vv.Particles([1.0], [[1.0, 2.0, 3.0]], [[1.0, 0.0, 0.0]]), array).run(t=1.0)
        out.save(tmp_path / "one.npz")
        assert vv.load(tmp_path / "one.npz").scene == out.scene
