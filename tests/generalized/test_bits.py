"""The same bits alone and in an ensemble, with any threads, on every tier, out of a pickle, whatever is read."""

import hashlib
import json
import os
import pickle
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from by_symbols import BY_SYMBOLS

import visviva as vv

T = np.linspace(0.0, 3.0, 7)


def copies() -> dict[str, Any]:
    """Ensembles of everything: places, velocities and parameters of their own, constraints, Hamiltonians, time."""
    random = np.random.default_rng(1)
    angles = random.uniform(-3.0, 3.0, (11, 2))
    hyperbola = vv.Lagrangian(
        lambda q, v, _, k: (
            (1 + np.exp(-(q[0] ** 2))) * v[0] ** 2 + v[1] ** 2 / (1 + q[0] ** 2) - k * np.sqrt(1 + q[1] ** 2)
        ),
        ["x", "y"],
        parameters={"k": 1.0},
        dissipation=lambda q, v, _, k: k * v[0] ** 2 * np.cos(q[1]) ** 2 / 20,
    )
    return {
        "pendulum": vv.systems.pendulum().ensemble(position=angles[:, :1], parameters={"l": np.linspace(0.5, 2, 11)}),
        "double": vv.systems.double_pendulum().ensemble(position=angles),
        "sphere": vv.systems.spherical_pendulum().ensemble(
            position=[1.0, 0.0] + angles / 6, velocity=[0.0, 2.0] + angles[::-1] / 6
        ),
        "chain": vv.systems.chain(4).ensemble(position=random.uniform(-1, 1, (9, 4))),
        "henon_heiles": vv.systems.henon_heiles().ensemble(momentum=random.uniform(-0.3, 0.3, (13, 2))),
        "charge": vv.systems.charged_particle().ensemble(velocity=random.normal(size=(3, 3))),
        "kapitza": vv.systems.kapitza(Omega=9.0).ensemble(parameters={"a": np.linspace(0.0, 0.3, 5)}),
        "atwood": vv.systems.atwood().ensemble(parameters={"m1": np.linspace(0.5, 3.0, 6)}),
        "curved": hyperbola.ensemble(position=angles / 3, velocity=angles[::-1] / 3),
    }


METHODS = {"gauss16": {}, "gauss4": {"dt": 0.05}, "dop853": {"rtol": 1e-9}, "taylor": {}, "rk4": {"dt": 0.02}}


def columns(out: Any) -> list[Any]:
    return [out.position, out.velocity, out.momentum, out.energy, out.reactions]


#: Of Lagrangians without constraints, and with them.
DISCRETE = {"variational_midpoint": {"dt": 0.05}, "variational_lobatto6": {"dt": 0.2}, "rattle4": {"dt": 0.05}}
HOW = METHODS | DISCRETE

# A square root has no series that could be trusted.
RUNS = [(name, method) for name in copies() for method in METHODS if (name, method) != ("curved", "taylor")]
RUNS += [(name, method) for name in ("double", "charge", "curved") for method in DISCRETE if method != "rattle4"]
RUNS += [("kapitza", "variational_midpoint"), ("atwood", "rattle4")]


@pytest.mark.parametrize(("name", "method"), RUNS)
def test_a_copy_has_the_bits_it_has_alone(name: str, method: str) -> None:
    many = copies()[name]
    how = {"method": method, **HOW[method]}
    out = many.run(T, threads=1, **how)
    for threads in (2, 3, None):
        for a, b in zip(columns(out), columns(many.run(T, threads=threads, **how)), strict=True):
            assert np.array_equal(a, b)
    for member in range(len(many)):
        alone = many[member].run(T, **how)
        for a, b, c in zip(columns(alone), columns(out), columns(out[member]), strict=True):
            assert np.array_equal(a, b[member])
            assert np.array_equal(a, c)
        assert (alone.steps, alone.evaluations) == (out.steps[member], out.evaluations[member])


@pytest.mark.parametrize("method", ["leapfrog", "kahan_li8", "stormer13"])
def test_a_copy_has_them_by_splittings_and_sums_too(method: str) -> None:
    many = copies()["henon_heiles"]
    out = many.run(T, method=method, dt=0.1, threads=2)
    for member in range(len(many)):
        assert np.array_equal(many[member].run(T, method=method, dt=0.1).position, out.position[member])


@pytest.mark.filterwarnings("ignore::visviva.AccuracyWarning")  # of the equal steps that are too long for one
@pytest.mark.parametrize("how", [{"dt": 0.1}, {}, {"max_step": 0.05, "rtol": 1e-6}])
@pytest.mark.parametrize("method", ["gauss4", "gauss8", "gauss16"])
def test_copies_of_their_own_pace_do_not_feel_each_other(method: str, how: dict[str, Any]) -> None:
    """Frequencies from 0.1 to 30: some take a hundredth of the steps of others; equal steps may be too long for one."""
    lengths = np.geomspace(1e-2, 1e3, 19)
    if "dt" in how:
        lengths[18] = 1e-12
    many = vv.systems.pendulum().ensemble(position=np.linspace(-3.0, 3.0, 19)[:, None], parameters={"l": lengths})
    for times in (np.linspace(0.0, 0.4, 5), [0.0, -0.2]):
        out = many.run(times, method=method, threads=1, **how)
        assert (out.status == vv.Status.OK)[9:18].all()
        for member in range(len(many)):
            try:
                alone = many[member].run(times, method=method, **how)
            except vv.ConvergenceError as error:
                alone = error.trajectory
            assert alone.status is vv.Status(out.status[member])
            read = len(alone.t)
            assert np.array_equal(alone.position, out.position[member, :read])
            assert np.isnan(out.position[member, read:]).all()
            assert (alone.steps, alone.evaluations) == (out.steps[member], out.evaluations[member])
        if "dt" in how:
            assert out.status[18] is not vv.Status.OK


def digest() -> dict[str, str]:
    """What a process on another tier computes."""
    found = {}
    for name, method in RUNS:
        out = copies()[name].run(T, method=method, **HOW[method])
        whole = b"".join(np.ascontiguousarray(column).tobytes() for column in columns(out))
        found[f"{name} {method}"] = hashlib.sha256(whole).hexdigest()
    for method in (*METHODS, "variational_midpoint"):
        marks = vv.events.expression(lambda q, v, _t, **_: np.sin(7 * q[1]) + v[0] / 9)
        table = copies()["double"].run(T, method=method, events=["theta1", marks], **HOW[method]).events
        whole = b"".join(column.tobytes() for column in (table.which, table.t, table.position, table.momentum))
        found[f"events {method}"] = hashlib.sha256(whole).hexdigest()
    return found


@pytest.mark.parametrize("tier", vv._core.info()["simd_available"])
@pytest.mark.parametrize("threads", ["1", "3"])
def test_every_tier_has_the_same_bits(tier: str, threads: str) -> None:
    program = f"import json, sys; sys.path[:0] = {[str(Path(__file__).parent)]!r}; import test_bits; "
    done = subprocess.run(
        [sys.executable, "-c", program + "print(json.dumps(test_bits.digest()))"],
        env=os.environ | {"VISVIVA_SIMD": tier, "VISVIVA_THREADS": threads},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout) == digest()


@pytest.mark.parametrize("name", BY_SYMBOLS)
def test_systems_and_runs_survive_a_pickle(name: str) -> None:
    rate = 8 if name == "chain_10" else None
    n = 10 if rate else 1 if name == "bead_on_hoop" else 2
    system = BY_SYMBOLS[name](position=np.linspace(0.3, 0.5, n), velocity=np.linspace(0.1, 0.2, n))
    out = system.run(T)
    for kept in (pickle.loads(pickle.dumps(system)), pickle.loads(pickle.dumps(system.at(t0=1.0))).at(t0=0.0)):
        again = kept.run(T)
        for a, b in zip(columns(out), columns(again), strict=True):
            assert np.array_equal(a, b)
        assert kept.coordinates == system.coordinates
        assert kept.parameters == system.parameters
    read = pickle.loads(pickle.dumps(out))
    for a, b in zip(columns(out), columns(read), strict=True):
        assert np.array_equal(a, b)
    assert read.status is out.status
    many = pickle.loads(pickle.dumps(system.ensemble(position=[system.position, system.position])))
    assert np.array_equal(many.run(T).position[1], out.position)


@pytest.mark.parametrize("method", METHODS)
def test_outputs_change_no_step(method: str) -> None:
    how = {"method": method, **METHODS[method]}
    system = vv.systems.double_pendulum()
    end = system.run(5.0, **how)
    for times in ([2.5, 5.0], np.linspace(0.0, 5.0, 1001), [1e-9, 5.0 - 1e-9, 5.0]):
        out = system.run(times, **how)
        assert np.array_equal(out.position[-1], end.position[-1])
        assert np.array_equal(out.velocity[-1], end.velocity[-1])
        assert out.steps == end.steps
    few, many = system.run([2.5, 5.0], **how), system.run(np.linspace(0.0, 5.0, 21), **how)
    assert np.array_equal(few.position[0], many.position[10])


def test_parameters_that_change_are_as_good_as_new_ones() -> None:
    there = vv.systems.double_pendulum(l1=0.5, m2=3.0).run(T)
    changed = vv.systems.double_pendulum().at(parameters={"m2": 3.0, "l1": 0.5}).run(T)
    assert np.array_equal(there.position, changed.position)
    assert np.array_equal(there.energy, changed.energy)
