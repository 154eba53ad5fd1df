"""Constraints: kept to the last bits, with reactions of the right size and sign; moving, and of velocities.

Bounds: constraints are projected to the last bits, some EPSILON of the largest number; places and reactions follow
closed forms to some ten roundings, 1e-14, and where a run of many turns lies between, to ten times what was reached;
of other methods the bound is their order's error of steps of 0.01.
"""

import pickle
from typing import Any

import numpy as np
import pytest
import sympy as sp
from by_symbols import coordinates

import visviva as vv

EPSILON = 2.0**-52
t = sp.Symbol("t")


def links(n: int, angles: Any, **further: Any) -> vv.Lagrangian:
    """A chain of n unit links by the places of its masses, half the squared lengths constrained."""
    q, v = coordinates(" ".join(f"x{i} y{i}" for i in range(1, n + 1)))
    lengths = [
        ((q[2 * i] - (q[2 * i - 2] if i else 0)) ** 2 + (q[2 * i + 1] - (q[2 * i - 1] if i else 0)) ** 2 - 1) / 2
        for i in range(n)
    ]
    L = sum(u**2 for u in v) / 2 - sp.Symbol("g") * sum(q[1::2])
    start = np.cumsum(np.stack([np.sin(angles), -np.cos(angles)], axis=1), axis=0).ravel()
    return vv.Lagrangian(
        L, q, parameters={"g": 9.81}, position=start, constraints=lengths, consistent="project", **further
    )


def gaps(positions: Any) -> Any:
    """How far links are from their length, in units of the last place."""
    places = np.asarray(positions).reshape(len(positions), -1, 2)
    steps = np.diff(places, axis=1, prepend=np.zeros((len(places), 1, 2)))
    return np.abs((steps**2).sum(axis=2) - 1.0) / 2 / EPSILON


@pytest.mark.parametrize("outputs", ["nodes", "between"])
@pytest.mark.parametrize(
    ("angles", "dt"), [([0.5, 0.625, 0.75], 0.05), ([1.0, 1.0, 1.0], 0.05), ([1.0, 1.25, 1.5], None)]
)
def test_a_chain_of_three_keeps_lengths_and_energy(angles: list[float], dt: float | None, outputs: str) -> None:
    """2000 steps of 0.05, too long ones for the wildest motion, which is on steps of its own."""
    chain = links(3, np.array(angles))
    assert chain.degrees_of_freedom == 3
    steps = 0.05 * np.arange(1, 2001)
    out = chain.run(steps if outputs == "nodes" else steps - 0.03, dt=dt)
    assert gaps(out.position).max() <= 4
    speed = np.abs((out.position * out.velocity)[:, :2].sum(axis=1)).max()
    assert speed <= 8 * EPSILON * np.abs(out.velocity).max()
    energy = out.energy
    # Chosen steps are as long as rtol = 1e-12 allows.
    assert np.ptp(energy) <= (5e-14 if dt is None else 5e-15) * np.abs(energy).max()
    # The same by angles: motions may be chaotic, so for a short time.
    turned = vv.systems.chain(3, position=angles).run([1.0, 2.0]).position
    places = np.cumsum(np.stack([np.sin(turned), -np.cos(turned)], axis=2), axis=1).reshape(2, -1)
    assert np.abs(chain.run([1.0, 2.0]).position - places).max() < 1e-12


@pytest.mark.parametrize("method", ["gauss16", "gauss8", "dop853", "verner98", "rk4"])
def test_methods_that_keep_constraints(method: str) -> None:
    how = {"dt": 0.01} if method in ("rk4", "gauss8") else {}
    out = links(2, np.array([1.0, 0.5])).run(np.linspace(0.0, 5.0, 41), method=method, **how)
    assert gaps(out.position).max() <= 4
    reference = vv.systems.chain(2, position=[1.0, 0.5]).run(5.0).position[-1]
    place = np.cumsum(np.stack([np.sin(reference), -np.cos(reference)], axis=1), axis=0).ravel()
    assert np.abs(out.position[-1] - place).max() < {"rk4": 1e-5, "gauss8": 1e-11}.get(method, 1e-10)


def test_reactions_are_forces_on_the_system_a_pendulums_tension() -> None:
    """λ ∂g/∂q with g = (r² − l²)/2l is a force along r: minus the tension m (g cos θ + l θ̇²)."""
    l, m, theta0 = 2.0, 3.0, 1.2
    (x, y), (vx, vy) = coordinates("x y")
    rod = vv.Lagrangian(
        m * (vx**2 + vy**2) / 2 - m * 9.81 * y,
        [x, y],
        position=[l * np.sin(theta0), -l * np.cos(theta0)],
        constraints=[(x**2 + y**2 - l**2) / (2 * l)],
        consistent="project",
    )
    out = rod.run(np.linspace(0.0, 10.0, 101))
    py, speed2 = out.position[:, 1], (out.velocity**2).sum(axis=1)
    tension = m * (9.81 * -py / l + speed2 / l)
    assert out.reactions.shape == (101, 1)
    assert np.abs(out.reactions[:, 0] + tension).max() <= 1e-14 * tension.max()
    # At the bottom m g (3 − 2 cos θ₀); no power: the energy is that of the start.
    bottom = vv.systems.pendulum(l=l, m=m, position=[theta0])
    quarter = rod.run(bottom.period() / 4)
    assert quarter.reactions[-1, 0] == pytest.approx(-m * 9.81 * (3 - 2 * np.cos(theta0)), rel=1e-13, abs=0)
    # Over the top the rod pushes where a string would be slack.
    fast = rod.at(position=[0.0, -l], velocity=[np.sqrt(4.2 * 9.81 * l), 0.0]).run(np.linspace(0.0, 3.0, 301))
    top = np.argmax(fast.position[:, 1])
    assert fast.position[top, 1] > 0.999 * l
    assert fast.reactions[top, 0] > 0.0


@pytest.mark.parametrize(("m1", "m2"), [(3.0, 2.0), (1.0, 1.0), (0.1, 7.0)])
def test_atwoods_machine(m1: float, m2: float) -> None:
    machine = vv.systems.atwood(m1=m1, m2=m2, length=3.0)
    assert machine.degrees_of_freedom == 1
    out = machine.run(np.linspace(0.0, 2.0, 21))
    acceleration = 9.81 * (m1 - m2) / (m1 + m2)
    assert np.abs(out.position[:, 0] - 1.5 - acceleration * out.t**2 / 2).max() <= 1e-14 * (1 + abs(acceleration))
    assert np.abs(out.reactions[:, 0] + 2 * m1 * m2 * 9.81 / (m1 + m2)).max() <= 1e-14 * 9.81 * (m1 + m2)
    assert np.abs(out.position.sum(axis=1) - 3.0).max() <= 2 * EPSILON * np.abs(out.position).max()


def test_a_bead_on_a_turning_rod_is_a_constraint_that_moves() -> None:
    """y cos Ωt = x sin Ωt: r = r₀ cosh Ωt, and the rod pushes with 2 m Ω ṙ across itself."""
    (x, y), (vx, vy) = coordinates("x y")
    m, Omega, r0 = 2.0, 1.5, 0.2
    across = y * sp.cos(Omega * t) - x * sp.sin(Omega * t)
    bead = vv.Lagrangian(
        m * (vx**2 + vy**2) / 2, [x, y], position=[r0, 0.0], velocity=[0.0, r0 * Omega], constraints=[across]
    )
    assert not bead.autonomous
    assert bead.conserved == []
    out = bead.run(np.linspace(0.0, 2.0, 21))
    r, rate = r0 * np.cosh(Omega * out.t), r0 * Omega * np.sinh(Omega * out.t)
    wanted = r[:, None] * np.stack([np.cos(Omega * out.t), np.sin(Omega * out.t)], axis=1)
    assert np.abs(out.position - wanted).max() <= 1e-14 * r.max()
    assert np.abs(out.reactions[:, 0] - 2 * m * Omega * rate).max() <= 2e-14 * rate.max()
    explicit = vv.systems.rod(m=m, Omega=Omega, position=[r0]).run(out.t)
    assert np.abs(explicit.position[:, 0] - r).max() <= 1e-14 * r.max()


def test_a_pendulum_on_a_moving_pivot_by_a_constraint() -> None:
    X, Y, Omega = 0.2, 0.1, 2.0
    (x, y), (vx, vy) = coordinates("x y")
    px, py = X * sp.cos(Omega * t), Y * sp.sin(Omega * t)
    theta0, rate0 = 0.5, 0.3
    moved = vv.Lagrangian(
        (vx**2 + vy**2) / 2 - 9.81 * y,
        [x, y],
        position=[X + np.sin(theta0), -np.cos(theta0)],
        velocity=[rate0 * np.cos(theta0), Y * Omega + rate0 * np.sin(theta0)],
        constraints=[((x - px) ** 2 + (y - py) ** 2 - 1) / 2],
        consistent="project",
    )
    times = np.linspace(0.0, 10.0, 51)
    out = moved.run(times)
    angle = vv.systems.moving_pivot(X=X, Y=Y, Omega=Omega, position=[theta0], velocity=[rate0]).run(times)["theta"]
    pivot = np.stack([X * np.cos(Omega * times), Y * np.sin(Omega * times)], axis=1)
    place = pivot + np.stack([np.sin(angle), -np.cos(angle)], axis=1)
    assert np.abs(out.position - place).max() <= 2e-14
    assert np.abs(((out.position - pivot) ** 2).sum(axis=1) - 1.0).max() <= 8 * EPSILON
    # From another time on, on and between nodes, by other methods, and back.
    on = moved.run(4.0).final
    assert on.t0 == 4.0
    for how in ({}, {"method": "dop853", "rtol": 1e-13}, {"dt": 0.05}):
        later = on.run(times[21:], **how)
        assert np.abs(later.position - place[21:]).max() <= 1e-11
        assert np.abs(((later.position - pivot[21:]) ** 2).sum(axis=1) - 1.0).max() <= 8 * EPSILON
    assert np.abs(on.run(times[:20][::-1]).position - place[:20][::-1]).max() <= 1e-11


def test_a_knife_edge_on_an_incline() -> None:
    """It does not slide down, but swings: x = a sin² ωt, y = a (ωt − sin 2ωt/2) with a = g sin α/2ω²."""
    (x, y, phi), (vx, vy, turning) = coordinates("x y phi")
    slope, omega = 3.0, 1.3
    edge = vv.Lagrangian(
        (vx**2 + vy**2 + turning**2 / 5) / 2 + slope * x,
        [x, y, phi],
        position=[0.0, 0.0, 0.0],
        velocity=[0.0, 0.0, omega],
        nonholonomic=[vx * sp.sin(phi) - vy * sp.cos(phi)],
    )
    assert edge.degrees_of_freedom == 2
    # y is in no function, too, but the constraint pushes along it.
    assert edge.cyclic == ["phi"]
    out = edge.run(np.linspace(0.0, 10.0, 101))
    a, angle = slope / (2 * omega**2), omega * out.t
    wanted = np.stack([a * np.sin(angle) ** 2, a * (angle - np.sin(2 * angle) / 2), angle], axis=1)
    assert np.abs(out.position - wanted).max() <= 1e-12
    sliding = out.velocity[:, 0] * np.sin(out.position[:, 2]) - out.velocity[:, 1] * np.cos(out.position[:, 2])
    assert np.abs(sliding).max() <= 8 * EPSILON * np.abs(out.velocity).max()
    # Constraints of velocities that do not know the time do no work.
    assert np.ptp(out.energy) <= 1e-13
    assert "energy" in edge.conserved


def test_a_disk_that_rolls_upright_goes_in_circles() -> None:
    (x, y, roll, turn), (vx, vy, rolling, turning) = coordinates("x y psi phi")
    R = 0.5
    disk = vv.Lagrangian(
        (vx**2 + vy**2) / 2 + rolling**2 * R**2 / 4 + turning**2 * R**2 / 8,
        [x, y, roll, turn],
        position=[0.0, 0.0, 0.0, 0.0],
        velocity=[R * 4.0, 0.0, 4.0, 0.8],
        nonholonomic=[vx - R * rolling * sp.cos(turn), vy - R * rolling * sp.sin(turn)],
    )
    assert disk.degrees_of_freedom == 2
    out = disk.run(np.linspace(0.0, 20.0, 101))
    radius = R * 4.0 / 0.8
    wanted = radius * np.stack([np.sin(0.8 * out.t), 1 - np.cos(0.8 * out.t)], axis=1)
    assert np.abs(out.position[:, :2] - wanted).max() <= 5e-14
    # The ground pushes toward the center with m v φ̇.
    push = 2.0 * 0.8 * np.stack([-np.sin(0.8 * out.t), np.cos(0.8 * out.t)], axis=1)
    assert np.abs(out.reactions - push).max() <= 1e-12


def test_holonomic_reactions_come_first() -> None:
    (x, y, z), (vx, vy, vz) = coordinates("x y z")
    both = vv.Lagrangian(
        (vx**2 + vy**2 + vz**2) / 2 - 9.81 * z,
        [x, y, z],
        position=[0.0, 0.0, 0.0],
        velocity=[1.0, 2.0, 0.0],
        constraints=[z],
        nonholonomic=[vy - 2 * vx],
        forces={y: 5.0},
    )
    reactions = both.run(1.0).reactions[-1]
    # The table carries the weight; across (−2, 1), of square 5, the force of 5 is held with −1.
    assert reactions == pytest.approx([9.81, -1.0], rel=1e-14, abs=0)


def test_a_start_off_its_constraints_is_refused_or_put_on_them() -> None:
    (x, y), (vx, vy) = coordinates("x y")
    L = (vx**2 + 4 * vy**2) / 2 - y
    ring = {"constraints": [(x**2 + y**2 - 1) / 2]}
    off = vv.Lagrangian(L, [x, y], position=[1.1, 0.1], velocity=[0.3, 1.0], **ring)
    with pytest.raises(vv.InvalidInput, match=r"constraint 0 is 0\.11 at the start.*consistent='project'"):
        off.run(1.0)
    on = vv.Lagrangian(L, [x, y], position=[1.1, 0.1], velocity=[0.3, 1.0], consistent="project", **ring)
    assert np.hypot(*on.position) == pytest.approx(1.0, abs=2 * EPSILON)
    assert abs(on.position @ on.velocity) <= 2 * EPSILON
    # The nearest velocities in the metric of the masses: the change is M⁻¹ ∂g/∂q times a number.
    change = (np.array([0.3, 1.0]) - on.velocity) * [1.0, 4.0]
    assert abs(change[0] * on.position[1] - change[1] * on.position[0]) <= 4 * EPSILON
    fast = vv.Lagrangian(L, [x, y], position=[1.0, 0.0], velocity=[0.3, 1.0], **ring)
    with pytest.raises(vv.InvalidInput, match=r"velocity: the rate of constraint 0 is 0\.3") as caught:
        fast.run(1.0)
    assert caught.value.argument == "velocity"
    with pytest.raises(vv.InvalidInput, match="expected 'project' or None, got 'yes'"):
        vv.Lagrangian(L, [x, y], position=[1.0, 0.0], consistent="yes", **ring)


def test_it_goes_on_and_pickles_with_constraints() -> None:
    chain = links(2, np.array([1.0, 0.5]))
    again = pickle.loads(pickle.dumps(chain))
    whole, half = again.run([2.0, 4.0]), chain.run(2.0)
    assert np.array_equal(chain.run([2.0, 4.0]).position, whole.position)
    assert np.abs(half.position[-1] - whole.position[0]).max() < 1e-14
    assert np.abs(half.final.run(4.0).position[-1] - whole.position[-1]).max() < 1e-14
    assert gaps(half.final.run(np.linspace(2.0, 4.0, 9)).position).max() <= 4


def test_copies_are_put_on_constraints_of_their_own() -> None:
    """Rods of three lengths from one start, on the first of them: off the others, refused unless projected."""
    rod = vv.Lagrangian(
        lambda q, v, t, l: (v[0] ** 2 + v[1] ** 2) / 2.0 - 9.81 * q[1],
        ["x", "y"],
        parameters={"l": 1.0},
        position=[0.6, -0.8],
        velocity=[0.8, 0.6],
        constraints=[lambda q, v, t, l: q[0] ** 2 + q[1] ** 2 - l**2],
    )
    lengths = np.array([1.0, 2.0, 0.5])
    with pytest.raises(vv.InvalidInput, match=r"copy 1: constraint 0 .* pass consistent='project'"):
        rod.ensemble(parameters={"l": lengths}).run(1.0)
    for threads in (1, 3):
        many = rod.ensemble(parameters={"l": lengths}, consistent="project")
        out = many.run(np.linspace(0.0, 1.0, 5), threads=threads)
        far = np.hypot(out.position[..., 0], out.position[..., 1])
        assert far == pytest.approx(np.broadcast_to(lengths[:, None], far.shape), rel=1e-15, abs=0)
        for k, length in enumerate(lengths):
            alone = rod.at(position=many[k].position, velocity=many[k].velocity, parameters={"l": length})
            assert np.array_equal(alone.run(np.linspace(0.0, 1.0, 5)).position, out.position[k])
            # Toward the pivot, and along the velocity that the rod allows.
            assert many[k].position == pytest.approx(length * np.array([0.6, -0.8]), rel=1e-15, abs=0)
    with pytest.raises(vv.InvalidInput, match="expected 'project' or None"):
        rod.ensemble(parameters={"l": lengths}, consistent="yes")  # type: ignore[arg-type]


def rod(**further: Any) -> vv.Lagrangian:
    """A mass on a rod of length l, whose pivot moves as 0.1 sin(w t) along x."""
    return vv.Lagrangian(
        lambda q, v, t, l, w: (v[0] ** 2 + v[1] ** 2) / 2.0 - 9.81 * q[1],
        ["x", "y"],
        parameters={"l": 1.0, "w": 2.0},
        constraints=[lambda q, v, t, l, w: ((q[0] - 0.1 * np.sin(w * t)) ** 2 + q[1] ** 2 - l**2) / 2.0],
        **further,
    )


def test_a_system_that_projects_its_start_projects_those_of_others() -> None:
    """Lengths, frequencies and starts of one's own: on the constraints to the last bits, as `at` and a system do it."""
    start = {"position": [0.6, -0.8], "velocity": [0.9, 0.5]}
    one = rod(consistent="project", **start)
    lengths, frequencies = np.array([1.0, 2.0, 0.5]), np.array([0.0, 3.0, 1.0])
    own = {"l": lengths, "w": frequencies}
    times = np.linspace(0.0, 1.0, 5)
    for threads in (1, 3):
        many = one.ensemble(parameters=own)
        out = many.run(times, threads=threads)
        pivot = 0.1 * np.sin(frequencies[:, None] * times)
        far = np.hypot(out.position[..., 0] - pivot, out.position[..., 1])
        assert far == pytest.approx(np.broadcast_to(lengths[:, None], far.shape), rel=4 * EPSILON, abs=0)
        for k in range(3):
            values = {"l": lengths[k], "w": frequencies[k]}
            for alone in (one.at(parameters=values), rod(consistent="project").at(parameters=values, **start)):
                assert alone.position == pytest.approx(many[k].position, rel=2 * EPSILON, abs=0)
                # The pivot moves with 0.1 w at the start: so does the rod along itself.
                radial = (alone.velocity - [0.1 * frequencies[k], 0.0]) @ alone.position
                assert abs(radial) <= 4 * EPSILON * np.abs(alone.velocity).max() * lengths[k]
            assert np.array_equal(many[k].run(times).position, out.position[k])
    starts = one.ensemble(position=[[3.0, 4.0], [0.0, -0.1]])
    assert starts[0].position == pytest.approx([0.6, 0.8], rel=2 * EPSILON, abs=0)
    assert starts[1].position == pytest.approx([0.0, -1.0], rel=2 * EPSILON, abs=0)
    # Without it they are refused, as before; and where nothing is near there is nothing to put them on.
    with pytest.raises(vv.InvalidInput, match=r"copy 1: constraint 0 is .* pass consistent='project'"):
        rod(position=[0.6, -0.8], velocity=[0.2, 0.0]).ensemble(parameters={"l": [1.0, 2.0]}).run(1.0)
    with pytest.raises(vv.InvalidInput, match="copy 1: constraint 0 has no gradient"):
        one.ensemble(position=[[1.0, 0.0], [0.0, 0.0]])
    square = vv.Lagrangian(
        lambda q, v, t, c: (v[0] ** 2 + v[1] ** 2) / 2.0,
        ["x", "y"],
        parameters={"c": 1.0},
        position=[1.0, 0.0],
        constraints=[lambda q, v, t, c: q[0] ** 2 + q[1] ** 2 - c],
        consistent="project",
    )
    with pytest.raises(vv.ConvergenceError, match=r"copy 1: the constraints .* cannot be met"):
        square.ensemble(parameters={"c": [1.0, -1.0]})
    with pytest.raises(vv.InvalidInput, match=r"copy 1: constraint 0 is .* start nearer to where all are 0"):
        square.ensemble(position=[[0.7, 0.0], [0.7, 0.0]], parameters={"c": [1.0, -1.0]}).run(1.0)


def test_that_starts_are_projected_is_kept(tmp_path: Any) -> None:
    """By pickle, and by files of runs and ensembles."""
    one = rod(consistent="project", position=[0.6, -0.8])
    wanted = one.at(parameters={"l": 2.0}).position
    assert wanted == pytest.approx([1.2, -1.6], rel=2 * EPSILON, abs=0)
    assert np.array_equal(pickle.loads(pickle.dumps(one)).at(parameters={"l": 2.0}).position, wanted)
    one.run(1.0).save(tmp_path / "one.npz")
    one.ensemble(parameters={"l": [1.0, 2.0]}).run(1.0).save(tmp_path / "many.npz")
    again: Any = vv.load(tmp_path / "one.npz")
    copies: Any = vv.load(tmp_path / "many.npz")
    for system in (again.system, copies.ensemble.system):
        assert np.array_equal(system.at(parameters={"l": 2.0}).position, wanted)


@pytest.mark.parametrize("how", [{}, {"method": "dop853"}, {"method": "rattle8", "dt": 0.015625}])
@pytest.mark.parametrize("threads", [1, 3])
def test_copies_with_constraints_run_on(how: dict[str, Any], threads: int, tmp_path: Any) -> None:
    """With lengths and moving pivots of their own: with the bits of one that runs on alone, which nothing moves again.

    And as in one run: 1e-11 is what the tolerance of 1e-12, or a hundred steps of order 8, leave in 4 time units.
    """
    own = {"l": [1.0, 2.0, 0.5], "w": [0.0, 3.0, 1.0]}
    many = rod(consistent="project", position=[0.6, -0.8], velocity=[0.9, 0.5]).ensemble(parameters=own)
    first = many.run([0.5, 1.5], threads=threads, **how)
    on = first.final.run([1.5, 4.0], threads=threads, **how)
    whole = many.run(4.0, threads=threads, **how)
    assert on.position[:, -1] == pytest.approx(whole.position[:, -1], rel=0, abs=1e-11)
    first.save(tmp_path / "copies.npz")
    again: Any = vv.load(tmp_path / "copies.npz")
    assert np.array_equal(again.final.run([1.5, 4.0], threads=threads, **how).position, on.position)
    for k in range(3):
        alone = many[k].run([0.5, 1.5], **how).final.run([1.5, 4.0], **how)
        assert np.array_equal(on.position[k], alone.position)
        assert np.array_equal(on.velocity[k], alone.velocity)
        assert np.array_equal(on.reactions[k], alone.reactions)
    # The start of the system is one of these, too: that of the first.
    assert first.final.system.t0 == 1.5
    assert np.array_equal(first.final.system.position, first.position[0, -1])
