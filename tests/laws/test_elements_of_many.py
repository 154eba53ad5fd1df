"""Elements of many bodies at once: each as of that body alone, what is refused is named, and the cost is the core's."""

import numpy as np
import pytest
from calls import python_calls

import visviva as vv
from visviva.orbits import Elements


def ring(count: int) -> vv.Scene:
    """Two stars and so many massless bodies on orbits of all shapes."""
    rng = np.random.default_rng(count)
    place, velocity = rng.normal(size=(count + 2, 3)), rng.normal(size=(count + 2, 3))
    return vv.Scene(vv.Particles([1.0, 0.5, *[0.0] * count], place, velocity), vv.Gravity(1.0))


@pytest.mark.parametrize("about", [0, 3, "jacobi", "center_of_mass"])
def test_each_has_the_bits_that_it_has_alone(about: int | str) -> None:
    rng = np.random.default_rng(7)
    bodies = vv.Particles(rng.uniform(0.1, 1.0, 6), rng.normal(size=(6, 3)), rng.normal(size=(6, 3)))
    scene = vv.Scene(bodies, vv.Gravity(2.0))
    copies = scene.ensemble(parameters={"Gravity": {"G": [2.0, 1.0]}})
    chosen = [body for body in (5, 1, 2, 4) if body != about]
    for what, axes in ((scene, ()), (scene.run(t=[0.1, 0.2]), (2,)), (copies.run(t=[0.1, 0.2]), (2, 2))):
        found = what.elements(chosen, about=about)
        assert found.mu.shape == (*axes, len(chosen))
        for column, body in enumerate(chosen):
            alone = what.elements(body, about=about)
            for name in Elements.__slots__:
                together = getattr(found, name)[(slice(None),) * len(axes) + (column,)]
                assert np.array_equal(together, getattr(alone, name), equal_nan=True), name


def test_who_has_no_orbit_is_named_among_many() -> None:
    """The first of the bodies as they were asked for, for its own reason; in a run with its row."""
    place = np.arange(300.0).reshape(100, 3)
    place[70] = place[0]
    place[40], place[0] = [1e308, 0, 0], [-1e308, 0, 0]
    scene = vv.Scene(vv.Particles(np.ones(100), place), vv.Gravity(1.0))
    with pytest.raises(vv.InvalidInput, match="distance of body 40 from body 0 within the range"):
        scene.elements()
    place[0], place[40] = place[70], -place[40] / 1e300
    scene = vv.Scene(vv.Particles([1.0, *[0.0] * 97, 1e308, 0.0], place), vv.Gravity(10.0))
    with pytest.raises(vv.InvalidInput, match=r"body 70 is at the very place of body 0 in row \(\)"):
        scene.elements()
    with pytest.raises(vv.InvalidInput, match="G times the masses is within the range") as caught:
        scene.elements([99, 98, 70])
    assert caught.value.argument == "G"
    with pytest.raises(vv.InvalidInput, match="neither body 1 nor body 50 attracts"):
        scene.elements(about=50)
    meet = vv.Particles([1.0, 0.0, 0.0], [[0, 0, 0], [5.0, 0, 0], [2.0, 0, 0]], [[0, 0, 0], [0, 0, 0], [-1.0, 0, 0]])
    free = vv.Scene(meet, vv.UniformField([0.0, 0.0, 0.0])).run(t=[1.0, 2.0, 3.0], method="rk4", dt=1.0)
    with pytest.raises(vv.InvalidInput, match=r"body 2 is at the very place of body 0 in row \(1,\)"):
        free.elements(G=1.0)


@pytest.mark.parametrize("about", ["jacobi", "center_of_mass"])
def test_about_centers_of_many(about: str) -> None:
    """Bodies that attract beside many that do not: the states that orbits are made of, and the bits of each alone.

    Bound: centers are sums of 300 places of size 1 with weights that add to 1, known to 300 roundings of 1e-16. So are
    r and v, of size 1, r × v, which is about 10 of them, and the energy, to some of them of μ/r.
    """
    rng = np.random.default_rng(11)
    mass = np.where(rng.uniform(size=(2, 300)) < 0.5, 0.0, rng.uniform(0.5, 1.0, (2, 300)))
    mass[:, 0] = 1.0
    place, velocity = rng.normal(size=(2, 300, 3)), rng.normal(size=(2, 300, 3))
    scene = vv.Scene(vv.Particles(mass[0], place[0], velocity[0]), vv.Gravity(1.0))
    copies = scene.ensemble(mass=mass, position=place, velocity=velocity)
    chosen = [299, 1, 150, 7, *range(200, 290)]
    found = copies.run(t=[0.0, 1e-9], method="leapfrog", dt=1e-9).elements(chosen, about=about)
    for copy in range(2):
        for column, body in enumerate(chosen):
            others = np.arange(300) < body if about == "jacobi" else np.arange(300) != body
            attracting = mass[copy, others].sum()
            r, v = (of[copy, body] - mass[copy, others] @ of[copy, others] / attracting for of in (place, velocity))
            mu = attracting + mass[copy, body]
            assert found.mu[copy, 0, column] == pytest.approx(mu, rel=3e-14, abs=0)
            np.testing.assert_allclose(found.angular_momentum[copy, 0, column], np.cross(r, v), rtol=0, atol=3e-13)
            depth = mu / np.linalg.norm(r)
            assert found.energy[copy, 0, column] == pytest.approx(v @ v / 2 - depth, rel=0, abs=3e-13 * depth)
        alone = copies[copy].elements(chosen, about=about)
        one = copies[copy].elements(chosen[-1], about=about)
        for name in Elements.__slots__:
            np.testing.assert_array_equal(getattr(found, name)[copy, 0], getattr(alone, name))
            np.testing.assert_array_equal(getattr(alone, name)[-1], getattr(one, name))


@pytest.mark.parametrize("about", [0, "jacobi", "center_of_mass"])
def test_no_python_is_run_for_each_body(about: int | str) -> None:
    few, many = ring(20), ring(400)
    short, long = few.run(t=[0.0, 1e-3]), many.run(t=[0.0, 1e-3])
    assert python_calls(lambda: many.elements(about=about)) == python_calls(lambda: few.elements(about=about))
    assert python_calls(lambda: long.elements(about=about)) == python_calls(lambda: short.elements(about=about))
