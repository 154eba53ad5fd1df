"""Springs that have a length by their Taylor series: beside closed forms, energies, Lagrangians and other methods.

Also where they are pressed together to nothing, which a series does not see. Bounds: steps by series are off by less
than a tenth of rtol each (of the places of a swing), which a passage or an encounter magnifies ten to a thousand times;
what they cannot be asked for is the rounding of a few hundred steps.
"""

import numpy as np
import numpy.typing as npt
import pytest
from nets import FIELDS, goes_as_by_another_method_with_its_own_bits, net

import visviva as vv

RNG = np.random.default_rng(59)


def falling(direction: npt.ArrayLike, k: float = 12.0, length: float = 1.0) -> vv.Scene:
    """Two bodies let go at three times the length of their spring, which is on their line."""
    along = np.asarray(direction) / np.linalg.norm(direction)
    bodies = vv.Particles([1.0, 3.0], [-2.25 * length * along, 0.75 * length * along], np.zeros((2, 3)))
    return vv.Scene(bodies, vv.Spring(0, 1, k=k, length=length))


def through_zero(angle: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """x″ = sign(x) − x from rest at 3: 1 + 2 cos t as far as 0, at 2π/3; on the other side the same in reverse."""
    third = 2.0 * np.pi / 3.0
    half_turns, angle = np.divmod(angle, 2.0 * third)
    x = np.where(angle < third, 1.0 + 2.0 * np.cos(angle), -1.0 - 2.0 * np.cos(2.0 * third - angle))
    return np.where(half_turns % 2 == 0, x, -x)


@pytest.mark.parametrize("direction", [[1, 0, 0], [0, -1, 0], [3, 4, 0], [1, 2, -2], [0.3, -0.7, 0.4]])
@pytest.mark.parametrize("rtol", [1e-6, 1e-9, 1e-12])
@pytest.mark.parametrize("forward", [True, False])
def test_a_spring_that_is_pressed_to_nothing_turns_about(direction: list[float], rtol: float, forward: bool) -> None:
    """Twenty times through zero, where the force jumps by 2 k length: ω² = k (1 + 1/3) = 16."""
    scene = falling(direction)
    times = np.linspace(0.0, 10.0 if forward else -10.0, 21)
    out = scene.run(t=times, method="taylor", rtol=rtol)
    along = np.asarray(direction) / np.linalg.norm(direction)
    apart = (out.position[:, 1] - out.position[:, 0]) @ along
    # A step that is off by rtol is early or late at the next passage, and so on: forty radians, twenty passages.
    assert np.abs(apart - through_zero(4.0 * np.abs(times))).max() < 400 * rtol + 1e-12
    # Starts that are off the line by a last digit pass beside each other, in steps that see that, to rtol of the
    # angular momentum; and each passage turns the line by some tens of that.
    across = out.position[:, 1] - out.position[:, 0] - apart[:, None] * along
    assert np.abs(across).max() < 200 * rtol + 1e-13
    # The center of mass does not move.
    assert np.abs(np.array([1.0, 3.0]) @ out.position).max() < 1e-13


@pytest.mark.parametrize("beside", [1e-1, 1e-3, 1e-6, 1e-9, 1e-13, 1e-17, 1e-30, 1e-160])
def test_ends_that_pass_each_other_closely_keep_energy_and_angular_momentum(beside: float) -> None:
    """A series about a place before a passage knows nothing of what its width makes of the force."""
    bodies = vv.Particles([1.0, 3.0], [[0.0, 0, 0], [1.0, beside, 0]], [[0.0, 0, 0], [-5.0, 0, 0]])
    scene = vv.Scene(bodies, vv.Spring(0, 1, k=4.0, length=1.0))
    out = scene.run(t=np.linspace(0.0, 10.0, 41), method="taylor", rtol=1e-12)
    other = scene.run(t=10.0, method="dop853", rtol=1e-13)
    energy = out.energy
    assert np.abs(energy / energy[0] - 1.0).max() < 1e-12
    d, v = out.position[:, 1] - out.position[:, 0], out.velocity[:, 1] - out.velocity[:, 0]
    turning = np.cross(d, v)[:, 2]
    # Twenty-five is the product of the largest distance and speed.
    assert turning == pytest.approx(5.0 * beside, rel=0, abs=25e-12)
    # Other methods step over the passage in steps that their error estimates leave: 5e-11 off among each other.
    assert np.abs(out.position[-1] - other.position[-1]).max() < 1e-9


@pytest.mark.parametrize("count", [2, 5, 8, 9, 20])
@pytest.mark.parametrize("dimensions", [2, 3])
@pytest.mark.parametrize("fields", FIELDS)
def test_nets_go_as_by_another_method_and_with_their_own_bits(count: int, dimensions: int, fields: str) -> None:
    scene = net(count, dimensions, extra=count // 2)
    scene = vv.Scene(scene.particles, *scene.forces, *FIELDS[fields], t0=0.25)
    goes_as_by_another_method_with_its_own_bits(scene, 2.25, "dop853")


@pytest.mark.parametrize("count", [2, 4, 12])
def test_copies_with_springs_of_their_own_have_the_bits_they_have_alone(count: int) -> None:
    scene = net(count, 3)
    links = count - 1
    own = {
        "k": RNG.uniform(1.0, 20.0, (37, links)),
        "length": np.where(RNG.uniform(size=(37, 1)) < 0.2, 0.0, RNG.uniform(0.5, 2.0, (37, links))),
    }
    copies = scene.ensemble(parameters={0: own})
    together = {n: copies.run(t=2.0, method="taylor", rtol=1e-10, threads=n) for n in (1, 2, 3)}
    for at, copy in enumerate(copies):
        alone = copy.run(t=2.0, method="taylor", rtol=1e-10)
        for out in together.values():
            assert np.array_equal(out[at].position, alone.position)
            assert np.array_equal(out[at].velocity, alone.velocity)


def test_ends_of_a_spring_without_length_may_meet_among_others() -> None:
    """The middle of three is at one place with the first, which a spring without length holds, and comes back there."""
    bodies = vv.Particles(
        np.ones(3), [[0.0, 0, 0], [0.0, 0, 0], [2.0, 0.5, 0]], [[0.0, 1, 0], [0.0, -1, 0], [0.0, 0, 1]]
    )
    scene = vv.Scene(bodies, vv.Spring([0, 1, 0], [1, 2, 2], k=[5.0, 2.0, 2.0], length=[0.0, 1.0, 1.0]))
    ours = scene.run(t=np.linspace(0.0, 5.0, 11), method="taylor", rtol=1e-12)
    other = scene.run(t=5.0, method="verner98", rtol=1e-13)
    # Fifteen radians of swings that magnify the tolerance some tens of times; energies err by rounding.
    assert ours.position[-1] == pytest.approx(other.position[-1], rel=0, abs=1e-10)
    assert ours.energy == pytest.approx(np.full(11, ours.energy[0]), rel=1e-12, abs=0)


@pytest.mark.parametrize("k", [1e4, 1e6, 1e8])
def test_stiff_springs_go_as_their_lagrangian(k: float) -> None:
    """A body on a stiff spring that falls, swings and comes back; series of both, which have nothing in common."""
    mass, g = (1.0, 3.0), 9.81
    start = [[1.0, 0.0, 0.0], [0.0, 0.0, 0.0]]
    fields = vv.UniformField([0.0, -g, 0.0]), vv.Harmonic(k=1.0)
    scene = vv.Scene(vv.Particles(mass, start, np.zeros((2, 3))), vv.Spring(0, 1, k=k, length=1.0), *fields)
    out = scene.run(t=2.0)
    assert out.plan.method == "taylor"
    x = [vv.coordinate(name) for name in ("x1", "y1", "x2", "y2")]
    speed = [one.diff(vv.time) for one in x]
    r = ((x[2] - x[0]) ** 2 + (x[3] - x[1]) ** 2) ** 0.5
    kinetic = sum(mass[n // 2] * speed[n] ** 2 for n in range(4)) / 2
    potential = k * (r - 1) ** 2 / 2 + sum(one**2 for one in x) / 2 + g * (mass[0] * x[1] + mass[1] * x[3])
    motion = vv.Lagrangian(kinetic - potential, x, position=[1.0, 0.0, 0.0, 0.0], velocity=[0.0] * 4)
    exact = motion.run(2.0, method="taylor", rtol=1e-14).position[-1].reshape(2, 2)
    # Fast swings have turned by 2 √(4k/3): to a few units in the last place of that.
    assert np.abs(out.position[-1, :, :2] - exact).max() < 2e-13 + 1e-16 * np.sqrt(k)


@pytest.mark.parametrize("far", [0.0, 1e3, 1e9])
@pytest.mark.parametrize("power", [-100, 0, 100])
def test_units_and_places_do_not_matter(power: int, far: float) -> None:
    scene = net(4, 3)
    base = scene.run(t=2.0, method="taylor", rtol=1e-12).position[-1]
    scale = 10.0**power
    moved = scene.with_state(scene.particles.position + far, scene.particles.velocity)
    moved = moved.rescaled(length=scale, mass=scale, time=scale)
    place = moved.run(t=2.0 * scale, method="taylor", rtol=1e-12).position[-1] / scale
    # Places far away have lost digits at the start, which the net magnifies ten times.
    assert np.abs(place - far - base).max() < 1e-10 + 1e-14 * far


def test_events_and_rows_lie_on_the_motion() -> None:
    """Apsides are where it turns back, at 4t = 4πn/3, and where it passes nothing, halfway."""
    times = np.sort(RNG.uniform(0.0, 3.0, 101))
    scene = falling([3, 4, 0])
    plain = scene.run(t=times, method="taylor", rtol=1e-12)
    out = scene.run(t=times, method="taylor", rtol=1e-12, events=[vv.events.apsis(1, 0)])
    assert np.array_equal(plain.position, out.position)
    apart = (out.position[:, 1] - out.position[:, 0]) @ [0.6, 0.8, 0.0]
    # Twelve radians and six passages, each of which is early or late by the tolerance.
    assert apart == pytest.approx(through_zero(4.0 * times), rel=0, abs=1e-10)
    table = out.events
    found = table.t[table.t > 1e-9]
    assert found == pytest.approx(np.pi / 6.0 * np.arange(1, 1 + len(found)), rel=0, abs=1e-10)
    assert len(found) == int(3.0 / (np.pi / 6.0))


@pytest.mark.parametrize("count", [3, 12])
def test_copies_with_masses_of_their_own_and_events_have_the_bits_they_have_alone(count: int) -> None:
    scene = net(count, 3)
    mass = RNG.uniform(0.5, 2.0, (37, count))
    copies = scene.ensemble(mass=mass)
    how = {"method": "taylor", "rtol": 1e-10, "events": [vv.events.apsis(1, 0), vv.events.plane([0, 0, 0], [0, 1, 0])]}
    together = {n: copies.run(t=2.0, threads=n, **how) for n in (1, 3)}
    for at in range(37):
        alone = copies[at].run(t=2.0, **how)
        for out in together.values():
            assert np.array_equal(out[at].position, alone.position)
            assert np.array_equal(out[at].events.t, alone.events.t)


def test_massless_bodies_beside_springs_under_gravity_change_nothing() -> None:
    """Two hundred of no mass, on one thread and on three."""
    three = net(3, 3)
    particles = three.particles
    light = vv.Particles(
        np.r_[particles.mass, np.zeros(200)],
        np.r_[particles.position, RNG.normal(size=(200, 3)) + np.array([0.0, 0.0, 9.0])],
        np.r_[particles.velocity, np.zeros((200, 3))],
    )
    forces = [*three.forces, vv.Gravity(0.5, softening=0.25)]
    for method in ("auto", "taylor", "dop853"):
        without = vv.Scene(particles, *forces).run(t=1.0, method=method)
        beside = {n: vv.Scene(light, *forces).run(t=1.0, method=method, threads=n) for n in (1, 3)}
        assert np.array_equal(beside[1].position, beside[3].position)
        # Of the tolerance alone: all are on steps of their own.
        assert beside[1].position[-1, :3] == pytest.approx(without.position[-1], rel=0, abs=1e-9)


def test_auto_takes_series_of_springs() -> None:
    def method(scene: vv.Scene) -> str:
        return scene.plan(t=1.0).method

    for count in (2, 8, 20):
        assert method(net(count, 3)) == "taylor"
        assert method(vv.Scene(net(count, 3).particles, *net(count, 3).forces, *FIELDS["fields"])) == "taylor"
    # Where eight springs in lanes have ends all over the place it takes longer.
    assert method(net(20, 3, extra=10)) == "verner98"
    # A body that only falls would be gone through in one step, in which events pass unseen.
    free = vv.Particles(np.ones(3), [[0.0, 0, 0], [1.0, 0, 0], [5.0, 0, 0]], np.zeros((3, 3)))
    assert method(vv.Scene(free, vv.Spring(0, 1, 3.0, 1.0), vv.UniformField([0.0, -1.0, 0.0]))) == "verner98"
