"""Elements of many bodies at once: each as of that body alone, what is refused is named, and the cost is the core's."""

import numpy as np
import pytest
from calls import python_calls

import visviva as vv
from visviva.orbits import Elements


def ring(count: int) -> vv.Scene:
    """A star and so many massless bodies on orbits of all shapes."""
    rng = np.random.default_rng(count)
    place, velocity = rng.normal(size=(count + 1, 3)), rng.normal(size=(count + 1, 3))
    return vv.Scene(vv.Particles([1.0, *[0.0] * count], place, velocity), vv.Gravity(1.0))


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


def test_no_python_is_run_for_each_body() -> None:
    few, many = ring(20), ring(400)
    short, long = few.run(t=[0.0, 1e-3]), many.run(t=[0.0, 1e-3])
    assert python_calls(lambda: many.elements(about=0)) == python_calls(lambda: few.elements(about=0))
    assert python_calls(lambda: long.elements(about=0)) == python_calls(lambda: short.elements(about=0))
