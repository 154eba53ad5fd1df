"""Names of bodies: kept by whatever is made from particles, taken wherever a body is meant, and nothing but names."""

import json
import pickle
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import visviva as vv

NAMES = ("Sun", "Jupiter", "Saturn", "Uranus", "Neptune", "Pluto")


def planets() -> vv.Scene:
    return vv.problems.outer_solar_system().scene


def unnamed(scene: vv.Scene) -> vv.Scene:
    p = scene.particles
    return vv.Scene(vv.Particles(p.mass, p.position, p.velocity), *scene.forces, t0=scene.t0)


def test_names_stay_with_the_bodies() -> None:
    scene = planets()
    assert scene.particles.names == NAMES
    turn = np.diag([-1.0, -1.0, 1.0])
    for made in (
        scene.shifted(position=[1.0, 0.0, 0.0]),
        scene.in_frame(velocity=[1.0, 0.0, 0.0]),
        scene.center_of_mass_frame(),
        scene.rotated(turn),
        scene.rescaled(time=2.0),
        scene.reversed(),
        scene.with_state(scene.particles.position, scene.particles.velocity),
        scene.run(10.0).final,
        scene.ensemble(mass=scene.particles.mass[None] * [[1.0], [2.0]])[1],
        scene.ensemble(mass=scene.particles.mass[None] * [[1.0], [2.0]])[0:1].run(10.0).final[0],
        pickle.loads(pickle.dumps(scene)),
    ):
        assert made.particles.names == NAMES


def test_a_file_keeps_them(tmp_path: Path) -> None:
    out = planets().run([0.0, 10.0])
    out.save(tmp_path / "run.npz")
    loaded = vv.load(tmp_path / "run.npz")
    assert isinstance(loaded, vv.Trajectory)
    assert loaded.scene == out.scene
    assert np.array_equal(loaded["Saturn"].position, out["Saturn"].position)
    many = planets().ensemble(mass=planets().particles.mass[None]).run(1.0)
    many.save(tmp_path / "many.npz")
    assert vv.load(tmp_path / "many.npz")["Pluto"].position.shape == (1, 2, 3)
    unnamed(planets()).run(1.0).save(tmp_path / "none.npz")
    assert vv.load(tmp_path / "none.npz").final.particles.names == ()


@pytest.mark.parametrize("names", [["Sun"] * 6, ["Sun"], "SJSUNP", {"Sun": 1}, [1, 2, 3, 4, 5, 6]])
def test_a_file_with_wrong_names_is_refused(tmp_path: Path, names: Any) -> None:
    path = tmp_path / "run.npz"
    planets().run(1.0).save(path)
    with zipfile.ZipFile(path) as archive:
        members = {info.filename: archive.read(info) for info in archive.infolist()}
    with np.load(path) as arrays:
        header = json.loads(arrays["header"].tobytes()) | {"names": names}
    with zipfile.ZipFile(path, "w") as archive:
        for name, content in members.items():
            if name != "header.npy":
                archive.writestr(name, content)
        with archive.open("header.npy", "w") as member:
            np.lib.format.write_array(member, np.frombuffer(json.dumps(header).encode(), dtype=np.uint8))
    with pytest.raises(vv.InvalidInput, match="names") as caught:
        vv.load(path)
    assert caught.value.argument == "path"


def test_they_change_no_bit() -> None:
    scene = planets()
    named, plain = (
        scene.run(1000.0, record=["position", "energy"]),
        unnamed(scene).run(1000.0, record=["position", "energy"]),
    )
    assert np.array_equal(named.position, plain.position)
    assert np.array_equal(named.energy, plain.energy)
    assert scene != unnamed(scene)
    assert hash(scene) != hash(unnamed(scene))
    assert scene == planets()
    assert hash(scene) == hash(planets())


def test_a_body_of_a_run() -> None:
    out = planets().run([0.0, 100.0, 200.0])
    body = out["Saturn"]
    assert (body.name, body.index, body.mass) == ("Saturn", 2, planets().particles.mass[2])
    assert np.array_equal(body.position, out.position[:, 2])
    assert np.shares_memory(body.position, out.position)
    assert np.array_equal(body.velocity, out.velocity[:, 2])
    assert np.array_equal(body.t, out.t)
    assert np.array_equal(out.body(2).position, body.position)
    assert np.array_equal(pickle.loads(pickle.dumps(body)).position, body.position)
    with pytest.raises(ValueError, match="read-only"):
        body.position[0] = 0.0
    with pytest.raises(vv.FrozenAttribute):
        body.name = "Moon"  # type: ignore[misc]
    for wrong in (0, slice(None), ("Saturn",)):
        with pytest.raises(vv.InvalidInput, match="name of a body"):
            out[wrong]  # type: ignore[index]
    with pytest.raises(TypeError, match="columns"):
        iter(out)
    with pytest.raises(vv.InvalidInput, match="did you mean 'Saturn'"):
        out["Satrun"]
    with pytest.raises(vv.InvalidInput, match="no names"):
        unnamed(planets()).run(1.0)["Sun"]
    assert unnamed(planets()).run(1.0).body(3).name == "body 3"


def test_a_body_of_an_ensemble() -> None:
    scene = planets()
    copies = scene.ensemble(velocity=scene.particles.velocity * np.array([1.0, 0.99])[:, None, None])
    out = copies.run([0.0, 100.0])
    body = out["Neptune"]
    assert body.position.shape == (2, 2, 3)
    assert body.mass.shape == (2,)
    assert np.array_equal(body.position[1], out[1]["Neptune"].position)


def test_some_of_the_bodies() -> None:
    bodies = planets().particles
    assert bodies["Saturn"].names == ("Saturn",)
    assert bodies[["Pluto", "Sun"]].names == ("Pluto", "Sun")
    assert bodies[2:4].names == ("Saturn", "Uranus")
    assert bodies[bodies.mass > 1e-4].names == ("Sun", "Jupiter", "Saturn")
    assert bodies[np.array([0, 5])].names == ("Sun", "Pluto")
    assert bodies[1] == bodies["Jupiter"]
    assert [body.names[0] for body in bodies] == list(NAMES)
    assert bodies.index("Uranus") == 3
    for wrong in ("Moon", 6, -1, [0, 9], np.zeros(3, dtype=bool)):
        with pytest.raises(vv.InvalidInput):
            bodies[wrong]


@pytest.mark.parametrize(
    "names",
    [["a"], ["a", "a"], ["a", ""], ["a", "  "], ["a", 3], "ab", 7, ["a", "center_of_mass"], ["jacobi", "a"]],
)
def test_names_are_one_for_each_body(names: Any) -> None:
    with pytest.raises(vv.InvalidInput) as caught:
        vv.Particles([1.0, 1.0], np.eye(3)[:2], names=names)
    assert caught.value.argument == "names"


def test_forces_take_them() -> None:
    bodies = vv.Particles([1.0, 2.0, 3.0], np.eye(3), names=["a", "b", "c"])
    by_name = vv.Scene(bodies, vv.Spring("a", ["c"], k=2.0, length=0.5))
    by_index = vv.Scene(bodies, vv.Spring(0, [2], k=2.0, length=0.5))
    assert by_name == by_index
    assert by_name.forces[0].i == 0  # type: ignore[attr-defined]
    mixed = vv.Scene(bodies, vv.Spring(["a", 1], ["b", "c"], k=2.0))
    assert mixed == vv.Scene(bodies, vv.Spring([0, 1], [1, 2], k=2.0))
    assert pickle.loads(pickle.dumps(vv.Spring("a", "b", k=1.0))) == vv.Spring("a", "b", k=1.0)
    with pytest.raises(vv.InvalidInput, match="expected one of the bodies a, b, c") as caught:
        vv.Scene(bodies, vv.Spring("a", "d", k=1.0))
    assert caught.value.argument == "j"
    with pytest.raises(vv.InvalidInput, match="no names"):
        vv.Scene(vv.Particles([1.0], [[0, 0, 0]]), vv.Spring("a", "b", k=1.0))


def test_events_take_them() -> None:
    scene = planets()
    named = [
        vv.events.apsis("Jupiter", "Sun"),
        vv.events.distance("Saturn", "Jupiter", below=9.0),
        vv.events.plane([0, 0, 0], [0, 1, 0], body="Uranus"),
        vv.events.apsis("Jupiter", [0.0, 0.0, 0.0]),
    ]
    numbered = [
        vv.events.apsis(1, 0),
        vv.events.distance(2, 1, below=9.0),
        vv.events.plane([0, 0, 0], [0, 1, 0], body=3),
        vv.events.apsis(1, [0.0, 0.0, 0.0]),
    ]
    one, other = scene.run(1e4, events=named), scene.run(1e4, events=numbered)
    assert len(one.events) > 3
    assert np.array_equal(one.events.t, other.events.t)
    assert one.events.definitions == other.events.definitions
    assert scene.plan(1e4, events=named).text == scene.plan(1e4, events=numbered).text
    copies = scene.ensemble(mass=scene.particles.mass[None])
    assert len(copies.run(1e4, events=named).events) == len(one.events)
    with pytest.raises(vv.InvalidInput, match="Jupiter") as caught:
        scene.run(1.0, events=[vv.events.apsis("Jupitr", "Sun")])
    assert caught.value.argument == "body"
    with pytest.raises(vv.InvalidInput, match="two bodies"):
        vv.events.apsis("Sun", "Sun")
    with pytest.raises(vv.InvalidInput, match="two bodies"):
        scene.run(1.0, events=[vv.events.distance("Sun", 0, below=1.0)])


def test_words_and_pictures_show_them() -> None:
    assert "Sun, Jupiter" in repr(planets().particles)
    bodies = vv.Particles([1.0, 1.0], [[0, 0, 0], [1, 0, 0]], names=["Romeo", "Juliet"])
    with pytest.raises(vv.CloseEncounter, match=r"Romeo and Juliet are|Juliet and Romeo are"):
        vv.Scene(bodies, vv.Gravity(1.0)).run(10.0, method="dop853")
    pytest.importorskip("matplotlib")
    figure = planets().run(np.linspace(0.0, 1e4, 50)).plot()
    legend = figure.axes[0].get_legend()
    assert legend is not None
    assert [text.get_text() for text in legend.get_texts()] == list(NAMES)
    assert unnamed(planets()).run([0.0, 1.0]).plot().axes[0].get_legend() is None
