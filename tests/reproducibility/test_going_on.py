"""A run with fixed steps that ends on a node goes on, from its ``final``, to the bits of one long run."""

from __future__ import annotations

import copy
import pickle
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from kept_files import parts, written

import visviva as vv

if TYPE_CHECKING:
    from collections.abc import Callable

FIXED = [method.name for method in vv.methods() if not method.adaptive]
STEP = 0.1
REFERENCE = Path(__file__).parents[1] / "reference"
# Some of what moves here is wild: two legs of it are to be the same, not right.
pytestmark = pytest.mark.filterwarnings("ignore:.*does not resolve:visviva.AccuracyWarning")


def bodies(count: int, massless: int = 0, seed: int = 1) -> vv.Particles:
    """So far apart that nothing much happens, on a plane that is tilted, moving as a whole."""
    rng = np.random.default_rng(seed)
    mass = rng.uniform(0.5, 1.5, count)
    mass[count - massless :] = 0.0
    position = 3.0 * np.arange(count)[:, None] + rng.uniform(-1.0, 1.0, (count, 3)) + 100.0
    return vv.Particles(mass, position, rng.uniform(-0.3, 0.3, (count, 3)) + np.array([0.3, -0.2, 0.1]))


def scenes() -> dict[str, vv.Scene]:
    gravity = vv.Gravity(G=1.0)
    driven = vv.DrivenForce([0.1, 0.2, 0.0], frequency=0.5)
    return {
        "two": vv.Scene(bodies(2), gravity),
        "two in a plane": vv.Scene(
            vv.Particles([1.0, 2.0], [[0, 0, 0], [3, 0, 0]], [[0, -0.7, 0], [0, 0.35, 0]]), gravity
        ),
        "three": vv.Scene(bodies(3), gravity),
        "three and massless": vv.Scene(bodies(3 + 70, 70), gravity),
        "three, falling": vv.Scene(bodies(3), gravity, vv.UniformField([0.0, 0.0, -0.1])),
        "five": vv.Scene(bodies(5, 1), gravity),
        "twelve": vv.Scene(bodies(12, 2), gravity),
        "driven": vv.Scene(bodies(4), gravity, driven),
        "apart": vv.Scene(bodies(11), vv.CentralField(potential=vv.potentials.Coulomb(-1.0))),
        "springs": vv.Scene(bodies(6), *(vv.Spring(i, i + 1, 2.0, 1.0) for i in (0, 3))),
        "dragged": vv.Scene(bodies(4), gravity, vv.LinearDrag(3.0)),
        "turned": vv.Scene(bodies(4), gravity, vv.UniformMagneticField([0.0, 1.0, 2.0])),
    }


def run(scene: Any, t: Any, method: str, **more: Any) -> Any:
    return scene.run(t=t, method=method, dt=STEP, **more)


def goes_on(result: Any) -> bool:
    return any(row[0] == "start" and "goes on" in row[1] for row in result.plan.rows)


def same(first: Any, second: Any, rows: Any = slice(None)) -> None:
    """The rows of the second are those of the first, and so is the end."""
    for name in ("position", "velocity"):
        assert np.array_equal(getattr(first, name)[..., rows, :, :], getattr(second, name)), name
    first, second = first.final, second.final
    assert first == second if isinstance(first, vv.Scene) else (first.position == second.position).all()


def served(name: str, scene: Any, method: str) -> None:
    try:
        scene.plan(t=1.0, method=method, dt=STEP)
    except vv.InvalidInput:
        assert name in ("dragged", "turned")  # what looks at velocities, no kick can take
        pytest.skip("the method does not serve it")


@pytest.mark.parametrize("method", FIXED)
@pytest.mark.parametrize("name", scenes())
def test_two_legs_have_the_bits_of_one(name: str, method: str) -> None:
    scene = scenes()[name]
    served(name, scene, method)
    whole = run(scene, [3.0, 4.0, 4.56, 6.0], method)
    second = run(run(scene, 3.0, method).final, [4.0, 4.56, 6.0], method)
    assert goes_on(second)
    same(whole, second, slice(1, None))
    assert 2 * second.stats.steps == whole.stats.steps


@pytest.mark.parametrize("method", FIXED)
@pytest.mark.parametrize("start", [0.0, 1e3, -7.5])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_many_legs_from_any_time_in_any_direction(method: str, start: float, sign: float) -> None:
    scene = vv.Scene(*(scenes()["driven"].particles, *scenes()["driven"].forces), t0=start)
    ends = start + sign * np.array([0.3, 0.9, 1.0, 2.0, 2.7, 4.0])  # a multistep method is still starting at the first
    whole = run(scene, ends, method)
    leg, rows = scene, []
    for end in ends:
        out = run(leg, [end], method)
        rows.append(out.position[-1])
        leg = out.final
    assert np.array_equal(whole.position, rows)
    # A leg of no length keeps what there is.
    assert goes_on(run(run(leg, leg.t0, method).final, leg.t0 + sign, method))


@pytest.mark.parametrize("method", FIXED)
@pytest.mark.parametrize("count", [2, 3, 5])
def test_ensembles_and_their_members(method: str, count: int) -> None:
    rng = np.random.default_rng(3)
    base = vv.Scene(bodies(count), vv.Gravity(G=1.0))
    mass = base.particles.mass * rng.uniform(0.9, 1.1, (19, count))
    mass[4:9, -1] = 0.0  # members differ in what is massless
    position = base.particles.position * rng.uniform(0.999, 1.001, (19, 1, 1))
    position[7] *= 2.0**200  # and one has units of its own
    copies = base.ensemble(mass=mass, position=position)
    whole = run(copies, [3.0, 4.0, 6.0], method)
    first = run(copies, [1.0, 2.0, 3.0], method)
    same(whole, run(first.final, [4.0, 6.0], method), slice(1, None))
    same(whole[5:9], run(first[5:9].final, [4.0, 6.0], method), slice(1, None))
    same(whole[5:9], run(first.final[5:9], [4.0, 6.0], method), slice(1, None))
    for member in (0, 4, 7, 18):
        same(whole[member], run(first[member].final, [4.0, 6.0], method, threads=2), slice(1, None))
        same(whole[member], run(first.final[member], [4.0, 6.0], method), slice(1, None))


@pytest.mark.parametrize("method", ["leapfrog", "rk4", "stormer13"])
def test_members_that_are_stopped_keep_nothing_and_the_others_all(method: str) -> None:
    base = vv.Scene(bodies(2), vv.Gravity(G=1.0))
    speeds = np.linspace(0.0, 2.0, 9)[:, None, None]
    copies = base.ensemble(velocity=base.particles.velocity + speeds * np.array([1.0, 0.0, 0.0]))
    height = float(base.particles.position[0, 0]) + 4.0
    event = vv.events.plane([height, 0.0, 0.0], [1.0, 0.0, 0.0], terminal=True)
    out = run(copies, 3.0, method, events=[event])
    whole = run(copies, 6.0, method)
    assert {vv.Status.OK, vv.Status.STOPPED} == {vv.Status(int(status)) for status in out.status}
    for member, one in enumerate(out):
        second = run(one.final, 6.0, method)
        assert goes_on(second) == (one.status == vv.Status.OK)
        if one.status == vv.Status.OK:
            assert np.array_equal(second.position[-1], whole.position[member, -1])


@pytest.mark.parametrize("how", ["pickle", "copy", "save"])
@pytest.mark.parametrize("method", ["yoshida4", "stormer13"])
@pytest.mark.parametrize("alone", [True, False])
def test_it_is_kept_with_the_scene(how: str, method: str, alone: bool, tmp_path: Path) -> None:
    scene: Any = scenes()["three and massless"]
    if not alone:
        scene = scene.ensemble(velocity=scene.particles.velocity * np.linspace(0.9, 1.0, 9)[:, None, None])
    whole = run(scene, [2.0, 4.0, 6.0], method)

    def kept(result: Any) -> Any:
        if how == "save":
            result.save(tmp_path / "run.npz")
            return vv.load(tmp_path / "run.npz")
        return pickle.loads(pickle.dumps(result)) if how == "pickle" else copy.deepcopy(result)

    second = kept(run(kept(run(scene, 2.0, method)).final, 4.0, method))
    third = kept(run(second.final, 6.0, method))
    assert goes_on(third)
    same(whole, third, slice(1, None))
    # What was run, too: run again it has the same bits.
    again = run((third.scene if alone else third.ensemble), 6.0, method)
    assert goes_on(again)
    same(third, again)


CHANGES: dict[str, Callable[[vv.Scene], vv.Scene]] = {
    "of its parts": lambda scene: vv.Scene(scene.particles, *scene.forces, t0=scene.t0),
    "with its state": lambda scene: scene.with_state(scene.particles.position, scene.particles.velocity),
    "in other units": lambda scene: scene.rescaled(length=1.0),
    "boosted": lambda scene: scene.shifted(velocity=[0.0, 0.0, 0.0]),
    "turned twice": lambda scene: scene.rotated(-np.eye(3)).rotated(-np.eye(3)),
    "a member": lambda scene: scene.ensemble(mass=scene.particles.mass[None])[0],
}


@pytest.mark.parametrize("change", CHANGES)
def test_a_scene_made_of_it_is_a_new_one(change: str) -> None:
    scene = scenes()["three"]
    end = run(scene, 3.0, "stormer13").final
    changed = CHANGES[change](end)
    assert changed == end
    assert hash(changed) == hash(end)
    new = run(changed, 6.0, "stormer13")
    assert not goes_on(new)
    same(run(CHANGES["of its parts"](end), 6.0, "stormer13"), new)
    # The rounded state lacks digits, so this is worth the trouble.
    assert not np.array_equal(new.position[-1], run(end, 6.0, "stormer13").position[-1])


@pytest.mark.parametrize(
    "asked",
    [
        {"method": "leapfrog", "dt": STEP},
        {"method": "stormer13", "dt": STEP / 2},
        {"method": "stormer13", "dt": STEP, "t": 0.0},
        {"method": "dop853"},
        {},
    ],
)
def test_another_method_step_or_direction_begins_anew(asked: dict[str, Any]) -> None:
    end = run(scenes()["three"], 3.0, "stormer13").final
    new, other = (scene.run(**{"t": 6.0, **asked}) for scene in (end, vv.Scene(end.particles, *end.forces, t0=end.t0)))
    assert not goes_on(new)
    same(other, new)


@pytest.mark.parametrize("method", FIXED)
def test_an_end_between_nodes_keeps_nothing(method: str) -> None:
    end = run(scenes()["three"], 3.04, method).final
    new = run(end, 6.0, method)
    assert not goes_on(new)
    same(run(vv.Scene(end.particles, *end.forces, t0=end.t0), 6.0, method), new)


@pytest.mark.parametrize("method", FIXED)
@pytest.mark.parametrize("steps", [5, 30])
def test_after_the_most_steps_it_goes_on(method: str, steps: int) -> None:
    scene = scenes()["twelve"]
    with pytest.raises(vv.ConvergenceError) as caught:
        run(scene, 6.0, method, max_steps=steps)
    end = caught.value.trajectory.final
    second = run(end, 6.0, method, max_steps=60 - steps)
    assert goes_on(second)
    assert np.array_equal(run(scene, 6.0, method).position[-1], second.position[-1])
    with pytest.raises(vv.ConvergenceError):
        run(end, 6.0, method, max_steps=59 - steps)


@pytest.mark.parametrize("method", FIXED)
def test_events_and_columns_on_the_way_are_those_of_the_whole(method: str) -> None:
    scene = scenes()["two in a plane"]
    event = vv.events.plane([0.0, 0.0, 0.0], [0.0, 1.0, 0.0])
    columns = ("energy", "position", "velocity")
    whole = run(scene, [3.0, 4.0, 6.0], method, events=[event], record=columns)
    first = run(scene, 3.0, method, events=[event])
    second = run(first.final, [4.0, 6.0], method, events=[event], record=columns)
    assert np.array_equal(whole.events.t, np.concatenate([first.events.t, second.events.t]))
    assert np.array_equal(whole.energy[1:], second.energy)
    same(whole, second, slice(1, None))


@pytest.mark.parametrize("method", ["leapfrog", "stormer13"])
@pytest.mark.parametrize("name", ["three and massless", "apart"])
def test_events_of_bodies_that_are_integrated_apart_are_those_of_the_whole(name: str, method: str) -> None:
    """They are looked for on bodies that are integrated together once more, which go on from where each of them is."""
    scene = scenes()[name]
    last = len(scene.particles) - 1
    gap = np.linalg.norm(np.diff(run(scene, [3.0, 6.0], method).position[:, [1, last]], axis=1)[:, 0], axis=-1)
    event = vv.events.distance(1, last, below=float(gap.mean()), direction=0)
    whole = run(scene, [3.0, 6.0], method, events=[event])
    second = run(run(scene, 3.0, method).final, 6.0, method, events=[event])
    assert goes_on(second)
    assert len(second.events.t) >= 1
    assert np.array_equal(whole.events.t[whole.events.t > 3.0], second.events.t)
    same(whole, second, [0, 1])


def altered(path: Path, change: Callable[[dict[str, Any], dict[str, Any]], None]) -> Any:
    """The run in the file after the change to header and arrays."""
    header, arrays = parts(path)
    change(header, arrays)
    return vv.load(written(path, header, arrays))


def test_what_does_not_belong_to_the_scene_is_not_used(tmp_path: Path) -> None:
    """Of another version, or of another state: then it runs as what it shows itself to be."""
    scene = scenes()["two"]

    def other_form(header: dict[str, Any], _: dict[str, Any]) -> None:
        header["continuation"]["form"] += 1

    def other_state(_: dict[str, Any], arrays: dict[str, Any]) -> None:
        arrays["final/held"] = arrays["final/held"] * (1.0 + 2.0**-50)

    def other_node(_: dict[str, Any], arrays: dict[str, Any]) -> None:
        arrays["final/node"] = arrays["final/node"] + 1

    def fewer_blocks(_: dict[str, Any], arrays: dict[str, Any]) -> None:
        arrays["final/held"] = arrays["final/held"][:, :-1].copy()

    for change in (other_form, other_state, other_node, fewer_blocks):
        path = tmp_path / f"{change.__name__}.npz"
        run(scene, 3.0, "stormer13").save(path)
        end = altered(path, change).final
        new = run(end, 6.0, "stormer13")
        assert not goes_on(new), change.__name__
        same(run(vv.Scene(end.particles, *end.forces, t0=end.t0), 6.0, "stormer13"), new)


def test_a_file_of_this_form_goes_on() -> None:
    """What is held means the same as when the file was written, or the form has another number and it is not used."""
    end = vv.load(REFERENCE / "goes_on_1.npz").final
    assert end.t0 == 3.0
    second = run(end, 6.0, "stormer13")
    assert goes_on(second)
    whole = run(scenes()["three and massless"], 6.0, "stormer13")
    # Some bits may be others by now; of numbers that mean something else none would be right.
    assert np.allclose(second.position[-1], whole.position[-1], rtol=0.0, atol=1e-11)


def test_a_file_that_lacks_a_part_of_it_is_refused(tmp_path: Path) -> None:
    first = run(scenes()["two"], 3.0, "leapfrog")
    for name, result in (("held", first), ("start_held", run(first.final, 4.0, "leapfrog"))):
        path = tmp_path / f"{name}.npz"
        result.save(path)
        with pytest.raises(vv.InvalidInput, match=f"final/{name}"):
            altered(path, lambda _, arrays, name=name: arrays.pop(f"final/{name}"))


def test_the_plan_says_from_which_node() -> None:
    end = run(scenes()["two"], 3.0, "leapfrog").final
    rows = end.plan(t=6.0, method="leapfrog", dt=STEP).rows
    assert [row[1] for row in rows if row[0] == "start"] == ["goes on from node 30"]
    assert not any(row[0] == "start" for row in end.plan(t=6.0).rows)


@pytest.mark.parametrize("method", FIXED)
def test_after_an_interruption_on_a_node_it_goes_on(method: str) -> None:
    def stop(t: float, *_: Any) -> float:
        if t > 2.05:
            raise KeyboardInterrupt
        return 1.0

    scene = scenes()["twelve"]
    with pytest.raises(vv.Interrupted) as caught:
        run(scene, 6.0, method, events=[stop])
    end = caught.value.trajectory.final
    assert 2.0 < end.t0 < 2.2
    second = run(end, 6.0, method)
    assert goes_on(second)
    assert np.array_equal(run(scene, 6.0, method).position[-1], second.position[-1])


@pytest.mark.parametrize("method", ["leapfrog", "rk4", "stormer13"])
@pytest.mark.parametrize("calls", range(3))
def test_after_an_interruption_in_the_middle_of_a_step_it_begins_anew(method: str, calls: int) -> None:
    """Of forces that take long: whatever is left behind is that of the node, or nothing is."""
    left = [calls]

    def stop(*_: int) -> None:
        left[0] -= 1
        if left[0] < 0:
            raise KeyboardInterrupt

    scene = vv.Scene(bodies(2500), vv.Gravity(G=1e-3))
    with pytest.raises(vv.Interrupted) as caught:
        run(scene, 2000.0, method, progress=stop, threads=1)  # it would take minutes
    end = caught.value.trajectory.final
    second = run(end, end.t0 + 0.5, method)
    new = vv.Scene(end.particles, *end.forces, t0=end.t0)
    whole = run(scene if goes_on(second) else new, end.t0 + 0.5, method)
    assert np.array_equal(whole.position[-1], second.position[-1])
