"""Saved runs in generalized coordinates: all comes back, damaged files are refused, earlier versions load."""

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from kept_files import parts, refused, the_old_file_stays, written

import visviva as vv
from visviva.generalized import GeneralizedEnsembleTrajectory, GeneralizedTrajectory

GOLDEN = Path(__file__).parent.parent / "reference" / "generalized_v1.npz"
COLUMNS = ("t", "position", "velocity", "momentum", "energy", "reactions")


def symbols() -> vv.Lagrangian:
    """Of SymPy's symbols, one of which is known to be positive."""
    sp = pytest.importorskip("sympy")
    theta, g = vv.coordinate("theta"), sp.Symbol("g", positive=True)
    return vv.Lagrangian(
        theta.diff(vv.time) ** 2 / 2 + g * sp.cos(theta), [theta], parameters={g: 9.81}, position=[0.1], t0=0.5
    )


def bead() -> vv.Lagrangian:
    """On a circle, with a drive and friction."""
    return vv.Lagrangian(
        lambda q, v, t, a: v @ v / 2 - q[1] + a * q[0] * np.cos(t),
        ["x", "y"],
        parameters={"a": 0.1},
        position=[1.0, 0.0],
        constraints=[lambda q, v, t, a: q @ q - 1],
        dissipation=lambda q, v, t, a: 0.05 * (v @ v),
        t0=0.5,
    )


def hamiltonian() -> vv.Hamiltonian:
    return vv.systems.henon_heiles().at(position=[0.1, 0.2], velocity=[0.3, 0.0], t0=0.5)


SYSTEMS: dict[str, Callable[[], Any]] = {"symbols": symbols, "constraint": bead, "hamiltonian": hamiltonian}
EVENTS = {"symbols": "theta", "constraint": "x", "hamiltonian": "x"}


def same(again: Any, out: Any) -> None:
    assert type(again) is type(out)
    for name in COLUMNS:
        assert np.array_equal(getattr(again, name), getattr(out, name), equal_nan=True), name
    assert np.array_equal(again.status, out.status)
    assert np.array_equal(again.steps, out.steps)
    assert np.array_equal(again.evaluations, out.evaluations)


@pytest.mark.parametrize("name", SYSTEMS)
def test_a_run_comes_back_whole_and_goes_on_to_the_bit(name: str, tmp_path: Path) -> None:
    system = SYSTEMS[name]()
    out = system.run(np.linspace(0.5, 2.0, 7), events=[EVENTS[name], vv.events.energy(0.3)])
    out.save(tmp_path / "run.npz")
    again = vv.load(tmp_path / "run.npz")
    assert isinstance(again, GeneralizedTrajectory)
    same(again, out)
    assert again.events.definitions == out.events.definitions
    for column in ("which", "t", "position", "velocity", "momentum"):
        assert np.array_equal(getattr(again.events, column), getattr(out.events, column))
    assert again.conservation() == out.conservation()
    assert again.system.parameters == out.system.parameters
    assert (again.final.t0, again.final.coordinates) == (out.final.t0, out.final.coordinates)
    assert np.array_equal(again.final.run(4.0).position, out.final.run(4.0).position)
    assert np.array_equal(again.system.run(out.t).position, out.position)


def test_symbols_are_the_very_same(tmp_path: Path) -> None:
    sp = pytest.importorskip("sympy")
    system = symbols()
    system.run(1.0).save(tmp_path / "run.npz")
    again = vv.load(tmp_path / "run.npz")
    assert isinstance(again, GeneralizedTrajectory)
    assert again.system._source.symbols == system._source.symbols
    theta = vv.coordinate("theta")
    assert np.array_equal(again.system.evaluate(sp.sin(theta)), system.evaluate(sp.sin(theta)))


def test_an_ensemble_comes_back_whole(tmp_path: Path) -> None:
    """One copy of which an event ends, so that rows differ from copy to copy."""
    many = vv.systems.pendulum().ensemble(position=[[0.1], [0.2], [3.1]], parameters={"l": [1.0, 2.0, 3.0]})
    out = many.run([0.0, 0.5, 1.0], events=[vv.events.coordinate("theta", 0.0, terminal=True)])
    assert len(set(out.status.tolist())) > 1
    out.save(tmp_path / "many.npz")
    again = vv.load(tmp_path / "many.npz")
    assert isinstance(again, GeneralizedEnsembleTrajectory)
    same(again, out)
    assert again.events.member.tolist() == out.events.member.tolist()
    for copy in range(3):
        same(again[copy], out[copy])
        assert np.array_equal(again[copy].final.run(3.0).position, out[copy].final.run(3.0).position)
    out[1].save(tmp_path / "one.npz")
    one = vv.load(tmp_path / "one.npz")
    assert isinstance(one, GeneralizedTrajectory)
    same(one, out[1])
    assert one.system.parameters["l"] == 2.0


def test_points_of_systems_come_back_and_those_of_ones_own_do_not(tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    vv.systems.double_pendulum().run([0.0, 1.0, 2.0]).save(tmp_path / "run.npz")
    again = vv.load(tmp_path / "run.npz")
    assert isinstance(again, GeneralizedTrajectory)
    assert again.animate() is not None
    bead().run([0.5, 1.0]).save(tmp_path / "bead.npz")
    other = vv.load(tmp_path / "bead.npz")
    assert isinstance(other, GeneralizedTrajectory)
    with pytest.raises(vv.InvalidInput, match="points"):
        other.animate()


def test_of_functions_and_expressions_as_events_words_are_kept(tmp_path: Path) -> None:
    sp = pytest.importorskip("sympy")
    theta = vv.coordinate("theta")
    out = symbols().run(2.0, events=[theta - sp.Rational(1, 20), vv.events.function(lambda t, q, v: q[0])])
    out.save(tmp_path / "run.npz")
    again = vv.load(tmp_path / "run.npz")
    assert isinstance(again, GeneralizedTrajectory)
    first, second = again.events.definitions
    assert dict(first.parameters) == {"name": "theta(t) - 1/20"}
    assert "lambda" in str(dict(second.parameters)["name"])
    with pytest.raises(vv.InvalidInput, match="give it again"):
        again.final.run(3.0, events=[first])


def test_a_failed_write_leaves_the_old_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    the_old_file_stays(tmp_path / "run.npz", bead().run(1.0), bead().run(2.0), monkeypatch)
    with pytest.raises(vv.InvalidInput, match="path"):
        bead().run(1.0).save(3)  # type: ignore[arg-type]


def use(out: Any) -> None:
    for name in (*COLUMNS, "status", "events"):
        getattr(out, name)
    assert repr(out)
    for each in [out] if isinstance(out, GeneralizedTrajectory) else list(out):
        assert each.conservation() is not None
        assert len(each.final.run(each.final.t0 + 0.1).t)


def refused_or_whole(path: Path) -> bool:
    """Whether the file is refused by name; if it loads, nothing fails later but the run of a changed system."""
    return refused(path, use)


@pytest.fixture(params=["one", "ensemble"])
def good(request: pytest.FixtureRequest, tmp_path: Path) -> Path:
    path = tmp_path / "good.npz"
    system = vv.systems.pendulum(position=[0.3])
    if request.param == "one":
        system.run([0.0, 0.5, 2.0], events=["theta"]).save(path)
    else:
        system.ensemble(position=[[0.1], [0.2]]).run([0.0, 0.5, 2.0], events=["theta"]).save(path)
    return path


def test_missing_and_misshapen_arrays_are_refused(good: Path, tmp_path: Path) -> None:
    header, arrays = parts(good)
    assert not refused_or_whole(written(tmp_path / "again.npz", header, arrays))
    for name, array in arrays.items():
        others = {other: value for other, value in arrays.items() if other != name}
        changed = [others, {**others, name: array.astype("f4")}, {**others, name: array[None]}]
        changed.append({**others, name: np.concatenate([array, array])})
        for number, each in enumerate(changed):
            # As many times again as were asked for are no contradiction of one run.
            if name == "times" and number == 3:
                continue
            assert refused_or_whole(written(tmp_path / "bad.npz", header, each)), (name, number)


def test_missing_and_wrong_words_are_refused(good: Path, tmp_path: Path) -> None:
    header, arrays = parts(good)
    for name in header.keys() - {"written_by"}:
        lacking = {other: value for other, value in header.items() if other != name}
        assert refused_or_whole(written(tmp_path / "bad.npz", lacking, arrays)), name
        assert refused_or_whole(written(tmp_path / "bad.npz", header | {name: {"x": [1]}}, arrays)), name
    for name in header["source"]:
        for value in ({"x": [1]}, 3, "word", [1, 2, 3]):
            wrong = header | {"source": header["source"] | {name: value}}
            # Of what a picture shows nothing is left.
            assert refused_or_whole(written(tmp_path / "bad.npz", wrong, arrays)) or name == "points"
    description = header["source"]["description"]
    for nodes in ([], [["sin", [5], 0.0]], [["nothing", [], 0.0]], description["nodes"][:-1], 3):
        wrong = header | {"source": header["source"] | {"description": description | {"nodes": nodes}}}
        assert refused_or_whole(written(tmp_path / "bad.npz", wrong, arrays))
    for changes in ({"status": 9}, {"lengths": -1}, {"found": 0}, {"events/which": 7}):
        each = {name: np.full_like(arrays[name], value) for name, value in changes.items()}
        assert refused_or_whole(written(tmp_path / "bad.npz", header, arrays | each)), changes


def test_files_cut_short_and_of_later_versions_are_refused(good: Path, tmp_path: Path) -> None:
    content = good.read_bytes()
    for length in range(0, len(content), max(1, len(content) // 40)):
        bad = tmp_path / "cut.npz"
        bad.write_bytes(content[:length])
        assert refused_or_whole(bad)
    header, arrays = parts(good)
    with pytest.raises(vv.InvalidInput, match="newer"):
        vv.load(written(tmp_path / "new.npz", header | {"version": 2}, arrays))


def test_the_file_of_version_1_loads() -> None:
    """Written once by version 0.1.0 and never again: this file must load in every later version."""
    out = vv.load(GOLDEN)
    assert isinstance(out, GeneralizedEnsembleTrajectory)
    assert out.position.shape == (2, 3, 1)
    assert out.events.which.tolist() == [0, 0]
    assert out[1].system.parameters == {"g": 9.81, "l": 2.0, "m": 1.0}
    # By gauss16, whose states within steps were read otherwise: the same to roundings of angles of a third of a radian.
    np.testing.assert_allclose(out.ensemble.run(out.t).position, out.position, rtol=0.0, atol=4e-16)


def test_a_file_loads_without_sympy(tmp_path: Path) -> None:
    path = tmp_path / "run.npz"
    symbols().run(1.0).save(path)
    code = (
        "import sys; sys.modules['sympy'] = None\n"
        f"import visviva as vv; print(vv.load({str(path)!r}).final.run(t=2.0).position[-1, 0])"
    )
    told = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    again = vv.load(path)
    assert isinstance(again, GeneralizedTrajectory)
    assert float(told) == again.final.run(2.0).position[-1, 0]


@pytest.mark.parametrize("method", ["auto", "taylor", "dop853"])
@pytest.mark.parametrize("threads", [1, 3])
def test_copies_run_on_from_where_they_ended(method: Any, threads: int, tmp_path: Any) -> None:
    """Each with its own parameters, with the bits of a single run that runs on, and also from a file.

    And as one long run, to what a step costs: 1e-10 of a radian.
    """
    start, lengths = np.array([[0.5], [1.0], [2.0]]), np.array([1.0, 2.0, 0.5])
    many = vv.systems.pendulum(position=[0.1]).ensemble(position=start, parameters={"l": lengths})
    first = many.run([0.0, 0.5, 1.5], method=method, threads=threads)
    first.save(tmp_path / "copies.npz")
    on = first.final.run([1.5, 4.0], method=method, threads=threads)
    assert first.final.system.t0 == 1.5
    again = vv.load(tmp_path / "copies.npz").final.run([1.5, 4.0], method=method, threads=threads)
    assert np.array_equal(on.position, again.position)
    whole = many.run([0.0, 4.0], method=method, threads=threads)
    assert on.position[:, -1] == pytest.approx(whole.position[:, -1], rel=0, abs=1e-8 if method == "dop853" else 1e-10)
    for k in range(3):
        alone = many[k].run([0.0, 0.5, 1.5], method=method).final.run([1.5, 4.0], method=method)
        assert np.array_equal(on.position[k], alone.position)
        assert np.array_equal(on.velocity[k], alone.velocity)


def test_copies_that_ended_at_times_of_their_own_run_on_one_by_one() -> None:
    many = vv.systems.pendulum().ensemble(position=[[0.5], [2.0]])
    out = many.run(3.0, events=[vv.events.coordinate("theta", terminal=True)])
    with pytest.raises(vv.InvalidInput, match=r"copies \[0, 1\] failed, were stopped or interrupted"):
        _ = out.final
    assert out[0].final.t0 != out[1].final.t0
