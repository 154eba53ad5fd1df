"""Close bodies keep their digits, wherever a far one is: the origin of the integration goes with most of them."""

import numpy as np
import pytest

import visviva as vv

METHODS = vv.methods()
NEAR = vv.Particles([1.0, 1.0], [[-0.5, 0.0, 0.0], [0.5, 0.0, 0.0]], [[0.0, -0.6, 0.0], [0.0, 0.6, 0.0]])


def arguments(method: vv.Method) -> dict[str, object]:
    tolerance = max(1e-12, 10.0**-method.order)
    return {"method": method.name, **({"rtol": tolerance} if method.adaptive else {"dt": 1.0 / 256})}


def separation(scene: vv.Scene, method: vv.Method) -> np.ndarray:
    position = scene.run(t=1.0, **arguments(method)).position[-1]
    return position[1] - position[0]


@pytest.mark.parametrize("method", [m for m in METHODS if m.name != "boris"], ids=lambda m: m.name)
@pytest.mark.parametrize("far", [1e7, 1e12, 1e16, 1e60])
@pytest.mark.parametrize("speed", [0.0, 1e5])
def test_two_close_bodies_do_not_feel_a_far_one(method: vv.Method, far: float, speed: float) -> None:
    """Its tide is far⁻³ of their attraction. About the center of mass of the three, 1e9 away, they had seven digits."""
    third = vv.Particles(
        np.append(NEAR.mass, 1.0),
        np.concatenate([NEAR.position, [[0.0, far, 0.0]]]),
        np.concatenate([NEAR.velocity, [[0.0, 0.0, speed]]]),
    )
    alone = separation(vv.Scene(NEAR, vv.Gravity(1.0)), method)
    apart = np.abs(separation(vv.Scene(third, vv.Gravity(1.0)), method) - alone).max()
    # Roundings of some 256 steps; adaptive methods take others, so their tolerance counts, for some steps.
    allowed = 100.0 * max(1e-12, 10.0**-method.order) if method.adaptive else 1e-13
    assert apart < allowed + far**-3.0


def test_a_moon_keeps_its_orbit_beside_a_star() -> None:
    """The star has all the mass, the center is in it: 2.7e5 astronomical units away the moon lost nine digits."""
    earth, moon, separation = 3.0e-6, 3.7e-8, 2.57e-3
    G = 2.959e-4
    speed = np.sqrt(G * (earth + moon) / separation)
    share = moon / (earth + moon)
    pair = vv.Particles(
        [earth, moon],
        [[-share * separation, 0.0, 0.0], [(1.0 - share) * separation, 0.0, 0.0]],
        [[0.0, -share * speed, 0.0], [0.0, (1.0 - share) * speed, 0.0]],
    )
    with_star = vv.Particles(
        np.append(pair.mass, 1.0),
        np.concatenate([pair.position, [[0.0, 2.7e5, 0.0]]]),
        np.concatenate([pair.velocity, np.zeros((1, 3))]),
    )
    runs = [
        vv.Scene(bodies, vv.Gravity(G)).run(t=365.25, method="kahan_li8", dt=0.25).position[-1]
        for bodies in (pair, with_star)
    ]
    alone, beside = (position[1] - position[0] for position in runs)
    # The tide is 1e-18 of their attraction; roundings of 1461 steps and 84 radians.
    assert np.abs(alone - beside).max() < 1e-12 * separation


def test_a_group_goes_on_as_if_alone_beside_what_it_is_not_coupled_to() -> None:
    spring = vv.Spring(0, 1, k=1.0, length=0.2)
    for far in (1.0, 1e9, 1e17):
        three = vv.Particles(
            np.append(NEAR.mass, 1.0),
            np.concatenate([NEAR.position, [[far, far, 0.0]]]),
            np.concatenate([NEAR.velocity, np.zeros((1, 3))]),
        )
        for method in ("dop853", "rk4", "kahan_li8"):
            how = arguments(next(m for m in METHODS if m.name == method))
            alone = vv.Scene(NEAR, spring).run(t=1.0, **how)
            beside = vv.Scene(three, spring).run(t=1.0, **how)
            assert np.array_equal(beside.position[-1, :2], alone.position[-1])


def test_a_drifting_cluster_and_slow_planets_are_still_integrated_about_their_center() -> None:
    """What the origin was made for: relative motion far away and fast is that at home, to a few roundings."""
    home = vv.problems.figure_eight().scene
    moved = home.shifted(position=[1e7, 2e7, -3e7], velocity=[1e3, -2e3, 500.0])
    here, there = (scene.run(t=6.0, method="kahan_li8", dt=0.01).position[-1] for scene in (home, moved))
    # Positions 4e7 away round to 7e-9; so do the given ones.
    assert np.abs((there - there[0]) - (here - here[0])).max() < 4e-8
