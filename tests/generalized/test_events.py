"""Events of runs in generalized coordinates: where they are, that none is missed, that they change nothing.

Bounds: a place of an event is found to some roundings of the largest number, its time to that over the speed there:
1e-15 to 1e-14, and 1e-12 at times of hundreds of steps whose errors add.
"""

import pickle
from typing import Any

import numpy as np
import pytest
import sympy as sp
from numpy.typing import NDArray

import visviva as vv
from visviva import events

ADAPTIVE = {method.name for method in vv.methods() if method.adaptive}
#: All that take an oscillator and a pendulum.
METHODS = [
    *(method.name for method in vv.methods() if method.name != "boris"),
    *("gauss4", "gauss8", "gauss16"),
    *("variational_midpoint", "variational_trapezoidal", "variational_lobatto4", "variational_lobatto8"),
]


def how(method: str, dt: float = 0.02) -> dict[str, Any]:
    return {"method": method, **({"rtol": 1e-11} if method in ADAPTIVE or method.startswith("gauss") else {"dt": dt})}


def states(out: Any) -> NDArray[np.float64]:
    return np.concatenate([out.position, out.velocity, out.momentum], axis=-1)


def oscillator(**start: Any) -> vv.Lagrangian:
    """q = cos t."""
    start = {"position": [1.0], **start}
    return vv.Lagrangian(lambda q, v, t: (v[0] ** 2 - q[0] ** 2) / 2, ["q"], **start)


def speed(_q: Any, v: Any, _t: Any, **_parameters: Any) -> Any:
    return v[0]


@pytest.mark.filterwarnings("ignore::visviva.AccuracyWarning")  # Euler's method, whose bits are as good as any
@pytest.mark.parametrize("method", METHODS)
def test_events_are_states_of_the_run_and_change_no_bit_of_it(method: str) -> None:
    swing = vv.systems.pendulum(g=1.0, position=[2.0])
    times = np.linspace(0.0, 20.0, 41)
    looked_for = ["theta", events.expression(speed), events.expression(lambda q, v, _t, **_: q[0] - v[0] + 0.3)]
    plain, out = swing.run(times, **how(method)), swing.run(times, events=looked_for, **how(method))
    assert np.array_equal(states(plain), states(out))
    assert plain.steps == out.steps
    table = out.events
    # A period is 8.35: theta passes 0 at 2.09, 6.26, …, 18.8, and turns at 4.17, 8.35, 12.5, 16.7. Euler gains energy
    # until it goes round.
    if method != "euler":
        assert [len(table.of(which)) for which in range(3)] == [5, 4, 5]
    assert (np.diff(table.t) > 0.0).all()
    # On the state itself, not on its time: round-off of numbers up to 2, and of a step of up to 3 units.
    residuals = [table.position[:, 0], table.velocity[:, 0], table.position[:, 0] - table.velocity[:, 0] + 0.3]
    for which, residual in enumerate(residuals):
        assert np.abs(residual[table.which == which]).max() < 4e-15
    # The states are those that an output at that time has, which is rounded to 2e-15.
    there = swing.run(np.append(table.t, 20.0), **how(method))
    assert np.abs(there.position[:-1] - table.position).max() < 2e-14
    assert np.abs(there.velocity[:-1] - table.velocity).max() < 2e-14
    np.testing.assert_array_equal(table.momentum, table.velocity)


@pytest.mark.parametrize("method", ["auto", "matrix_exponential", "gauss16", "dop853", "taylor"])
@pytest.mark.parametrize("end", [30.0, -30.0])
@pytest.mark.parametrize("direction", [1, -1, 0])
def test_zeros_of_an_oscillator_are_where_they_are(method: str, end: float, direction: int) -> None:
    out = oscillator().run(end, method=method, rtol=1e-14, events=[events.coordinate("q", 0.25, direction=direction)])
    first = np.arccos(0.25)
    # Of cos t = 1/4 those are upwards in time where sin t < 0.
    every = np.array([s * first + 2 * np.pi * k for k in range(-6, 7) for s in (-1, 1)])
    rising, falling = every[np.sin(every) < 0.0], every[np.sin(every) > 0.0]
    wanted = {1: rising, -1: falling, 0: every}[direction]
    wanted = wanted[(wanted * end > 0.0) & (np.abs(wanted) < 30.0)]
    wanted = wanted[np.argsort(np.abs(wanted))]
    # A slope of 0.97: round-off of thirty units of time, of some steps each.
    np.testing.assert_allclose(out.events.t, wanted, rtol=0.0, atol=5e-14)
    assert np.abs(out.events.position - 0.25).max() < 1e-15


@pytest.mark.parametrize("method", ["gauss16", "gauss4", "taylor", "dop853", "rk4", "leapfrog", "variational_lobatto8"])
@pytest.mark.parametrize("wave", [7.0, 50.0, 301.0])
def test_many_zeros_in_one_step_are_all_found(method: str, wave: float) -> None:
    """A free rotor takes steps of any length; each unit of angle has as many marks as the wave number says."""
    start: dict[str, Any] = {"velocity": [1.0], "position": [0.1]}
    rotor = vv.Lagrangian(lambda q, v, t, k: v[0] ** 2 / 2, ["q"], parameters={"k": wave}, **start)
    marks = events.expression(lambda q, _v, _t, k: np.sin(k * q[0]))
    step = {"dt": 0.5} if method in ("rk4", "leapfrog", "variational_lobatto8") else {}
    out = rotor.run(10.0, method=method, events=[marks], **step)
    wanted = np.pi / wave * np.arange(np.ceil(0.1 * wave / np.pi), np.floor(10.1 * wave / np.pi) + 1)
    # Steps of dop853 round the coordinate; the others have it at once.
    np.testing.assert_allclose(out.events.position[:, 0], wanted, rtol=4e-15, atol=0.0)


@pytest.mark.parametrize("method", [name for name in METHODS if name not in ("euler", "heun", "midpoint")])
@pytest.mark.parametrize("below", [1e-4, 1e-8])
def test_two_zeros_about_a_turn_in_one_step_are_found(method: str, below: float) -> None:
    """About each top q = A cos t exceeds A − δ for 2·sqrt(2δ/A): a small part of any step."""
    step = how(method, dt=0.05)
    turns = oscillator().run(40.0, events=[events.expression(speed, direction=-1)], **step).events
    top = float(turns.position.min())
    out = oscillator().run(40.0, events=[events.coordinate("q", top * (1.0 - below))], **step)
    expected = np.repeat(turns.t, 2).reshape(-1, 2) + np.sqrt(2 * below) * np.array([-1.0, 1.0])
    # The first is where the run begins, of which there is one half; tops of methods that lose energy are not alike.
    found = out.events.t[out.events.t > 1.0]
    lost = 1.0 - turns.position.min() / turns.position.max()
    if lost < 0.01 * below:
        np.testing.assert_allclose(found, expected.ravel(), rtol=0.0, atol=0.1 * np.sqrt(2 * below))
    assert len(found) % 2 == 0
    assert len(found) >= 2


@pytest.mark.parametrize("method", ["auto", "gauss16", "dop853", "taylor", "leapfrog", "variational_midpoint"])
@pytest.mark.parametrize("end", [50.0, -50.0])
def test_a_terminal_event_ends_the_run_and_it_runs_on(method: str, end: float) -> None:
    step = {"dt": 0.05} if method in ("leapfrog", "variational_midpoint") else {}
    third = events.coordinate("q", 0.25, terminal=3)
    times = np.linspace(0.0, end, 101)
    out = oscillator().run(times, method=method, events=[third, "q"], **step)
    assert out.status is vv.Status.STOPPED
    assert out.events.which.tolist() == [0, 1, 1, 0, 0]
    stop = out.events.t[-1]
    assert len(out.t) == np.count_nonzero(np.abs(times) <= abs(stop))
    whole = oscillator().run(times, method=method, **step)
    assert np.array_equal(states(out), states(whole)[: len(out.t)])
    assert out.final.t0 == stop
    np.testing.assert_array_equal(out.final.position, out.events.position[-1])
    np.testing.assert_array_equal(out.final.velocity, out.events.velocity[-1])
    # It begins on a zero, which does not count, and meets the next: half a period and more later.
    on = out.final.run(end, method=method, events=[third], **step)
    every = oscillator().run(end, method=method, events=[events.coordinate("q", 0.25)], **step).events.t
    # Steps begin anew: a method of second order errs by (ωh)²/24 of a time in either.
    np.testing.assert_allclose(on.events.t, every[3:6], rtol=0.0, atol=1e-4 if step else 1e-11)


def test_running_on_from_event_to_event_meets_each_once() -> None:
    system: Any = vv.systems.double_pendulum(position=[1.0, 0.5])
    every = system.run(20.0, events=["theta1", "theta2"]).events
    met = []
    for _ in range(len(every)):
        looked_for = [events.coordinate(name, terminal=True) for name in ("theta1", "theta2")]
        system = system.run(20.0, events=looked_for).final
        met.append(system.t0)
    # This one is chaotic: what differs by round-off grows by some thousands in this time.
    np.testing.assert_allclose(met, every.t, rtol=0.0, atol=1e-8)


def test_functions_that_are_called_find_what_expressions_do() -> None:
    def called(t: float, q: NDArray[np.float64], v: NDArray[np.float64]) -> float:
        assert q.shape == v.shape == (2,)
        return float(abs(q[1]) - 0.5) if t < 50.0 else 1.0

    system = vv.systems.spring_pendulum(position=[1.0, 1.2])
    by_call = system.run(20.0, events=[events.function(called)])
    sides = [events.coordinate("theta", value) for value in (0.5, -0.5)]
    by_value = system.run(20.0, events=sides)
    assert len(by_call.events) == len(by_value.events) > 10
    np.testing.assert_allclose(by_call.events.t, by_value.events.t, rtol=0.0, atol=1e-14)
    # A turn that is followed down by the golden section: q = cos t above 1 − 1e-6 for 2.8e-3.
    turns = oscillator().run(30.0, events=[events.function(lambda t, q, v: q[0] - 1.0 + 1e-6)]).events.t
    expected = 2 * np.pi * np.arange(1, 5)[:, None] + np.sqrt(2e-6) * np.array([-1.0, 1.0])
    np.testing.assert_allclose(turns[1:], expected.ravel(), rtol=0.0, atol=1e-8)


def test_what_a_function_raises_is_raised() -> None:
    error = RuntimeError("of my own")

    def fails(t: float, _q: Any, _v: Any) -> float:
        if t > 1.0:
            raise error
        return 1.0

    for system in (vv.systems.pendulum(position=[1.0]), oscillator()):
        with pytest.raises(RuntimeError) as raised:
            system.run(5.0, events=[events.function(fails)])
        assert raised.value is error
    with pytest.raises(RuntimeError):
        vv.systems.pendulum().ensemble(position=[[0.1], [0.2]]).run(5.0, events=[events.function(fails)])


@pytest.mark.parametrize("method", ["gauss16", "dop853", "taylor", "rk4", "variational_lobatto4"])
def test_copies_have_the_events_that_they_have_alone(method: str) -> None:
    starts = np.linspace(0.2, 3.0, 9)[:, None]
    many = vv.systems.pendulum().ensemble(position=starts, parameters={"l": np.linspace(0.5, 2.0, 9)})
    bob = events.expression(lambda q, _v, _t, l, **_: l * np.sin(q[0]) - 0.3, direction=1)
    looked_for = ["theta", bob, events.coordinate("theta", 2.5, terminal=2)]
    step = {"dt": 0.01} if method in ("rk4", "variational_lobatto4") else {}
    times = np.linspace(0.0, 10.0, 11)
    out = many.run(times, method=method, events=looked_for, threads=1, **step)
    table = out.events
    for threads in (2, 3, None):
        other = many.run(times, method=method, events=looked_for, threads=threads, **step).events
        for name in ("which", "t", "position", "velocity", "momentum", "member"):
            assert np.array_equal(getattr(other, name), getattr(table, name))
    assert (out.status == vv.Status.STOPPED).any()
    assert (out.status == vv.Status.OK).any()
    assert np.isnan(out.position[out.status == vv.Status.STOPPED, -1]).all()
    for member in range(9):
        alone = many[member].run(times, method=method, events=looked_for, **step)
        own = table[table.member == member]
        for lines in (alone.events, out[member].events):
            for name in ("which", "t", "position", "velocity", "momentum"):
                assert np.array_equal(getattr(own, name), getattr(lines, name))
        assert np.array_equal(alone.position, out.position[member, : len(alone.t)])
        assert out[member].final.t0 == alone.final.t0
        l = many[member].parameters["l"]
        there = own.of(1).position[:, 0]
        assert np.abs(l * np.sin(there) - 0.3).max(initial=0.0) < 2e-15
    # Lengths that differ, and one copy that never comes so high.
    assert len(set(np.bincount(table.member).tolist())) > 2


def test_momenta_energies_times_and_parameters() -> None:
    """A body that drag slows, v = v0 exp(−k t/m): its energy and momentum pass values at known times."""
    slowed = vv.Lagrangian(
        lambda q, v, t, m, k: m * v[0] ** 2 / 2,
        ["x"],
        parameters={"m": 2.0, "k": 0.6},
        position=[0.0],
        velocity=[3.0],
        dissipation=lambda q, v, t, m, k: k * v[0] ** 2 / 2,
    )
    looked_for = [
        events.energy(1.0),
        events.expression(lambda q, v, t, m, k: m * v[0] - 1.5),
        events.expression(lambda q, v, t, m, k: t - 2.0),
        events.energy(1.0, direction=1),
    ]
    for method in ("auto", "dop853", "gauss16"):
        table = slowed.run(5.0, method=method, rtol=1e-13, events=looked_for).events
        wanted = {0: np.log(9.0) / 0.6, 1: np.log(4.0) / 0.3, 2: 2.0}
        assert sorted(table.which.tolist()) == [0, 1, 2]
        for which, t in wanted.items():
            assert table.of(which).t == pytest.approx([t], abs=1e-12)
        assert table.of(1).momentum == pytest.approx(1.5, abs=1e-15)
    # Of a Hamiltonian the second half of a state is its momenta.
    free = vv.Hamiltonian(
        lambda q, p, t, m, g: p[0] ** 2 / (2 * m) + m * g * q[0],
        ["z"],
        parameters={"m": 2.0, "g": 4.0},
        position=[0.0],
        momentum=[8.0],
    )
    table = free.run(3.0, method="gauss16", events=[events.expression(lambda q, p, t, m, g: p[0] - 2.0), "z"]).events
    np.testing.assert_allclose(table.t, [0.75, 2.0], rtol=1e-14)
    np.testing.assert_allclose(table.momentum[:, 0], [2.0, -8.0], rtol=1e-14)
    np.testing.assert_allclose(table.velocity[:, 0], [1.0, -4.0], rtol=1e-14)


@pytest.mark.parametrize("method", ["gauss16", "dop853", "rattle", "rattle4"])
def test_events_with_constraints(method: str) -> None:
    """A pendulum in x and y: where it hangs straight down, the constraint is kept."""
    bob = vv.Lagrangian(
        lambda q, v, t: (v[0] ** 2 + v[1] ** 2) / 2 - q[1],
        ["x", "y"],
        constraints=[lambda q, v, t: (q[0] ** 2 + q[1] ** 2 - 1) / 2],
        position=[np.sin(1.0), -np.cos(1.0)],
    )
    step = {"dt": 0.01} if method.startswith("rattle") else {"rtol": 1e-13}
    plain, out = bob.run(20.0, method=method, **step), bob.run(20.0, method=method, events=["x"], **step)
    assert np.array_equal(states(plain), states(out))
    angle = vv.systems.pendulum(g=1.0, position=[1.0])
    exact = angle.period() * (0.25 + 0.5 * np.arange(6))
    bar = {"rattle": 1e-3, "rattle4": 1e-7}.get(method, 1e-11)
    np.testing.assert_allclose(out.events.t, exact[exact < 20.0], rtol=0.0, atol=bar)
    # Projection moves a state by its error after it was located.
    assert np.abs(out.events.position[:, 0]).max() < 2e-15
    assert np.abs(np.hypot(*out.events.position.T) - 1.0).max() < 4e-15


def test_expressions_of_sympy_mean_what_the_system_calls_them() -> None:
    q = vv.coordinate("q")
    k = sp.Symbol("k")
    by_symbols = vv.Lagrangian(q.diff(vv.time) ** 2 / 2 - k * q**2 / 2, [q], parameters={k: 4.0}, position=[1.0])
    by_function = vv.Lagrangian(
        lambda q, v, t, k: v[0] ** 2 / 2 - k * q[0] ** 2 / 2, ["q"], parameters={"k": 4.0}, position=[1.0]
    )
    given = [q - 0.5, q.diff(vv.time) + k * q, lambda q, v, t, k: q[0] * v[0] - 0.1 * k, events.coordinate(q, 0.1)]
    tables = [system.run(5.0, events=given).events for system in (by_symbols, by_function)]
    assert len(tables[0]) > 8
    assert np.array_equal(tables[0].which, tables[1].which)
    np.testing.assert_allclose(tables[0].t, tables[1].t, rtol=1e-15)
    # q = cos 2t = 1/2, and q' + 4 q = 0 where tan 2t = 2.
    np.testing.assert_allclose(tables[0].of(0).t, [np.pi / 6, 5 * np.pi / 6, 7 * np.pi / 6], rtol=1e-14)
    np.testing.assert_allclose(tables[0].of(1).t, (np.arctan(2.0) + np.pi * np.arange(3)) / 2, rtol=1e-14)


def test_a_zero_at_the_start_does_not_count_and_one_at_the_end_does() -> None:
    fall = vv.systems.constant_force(position=[0.0], velocity=[0.0])
    assert len(fall.run(1.0, events=["x"]).events) == 0
    throw = vv.Lagrangian(lambda q, v, t: v[0] ** 2 / 2 - q[0], ["z"], velocity=[1.0], position=[0.0])
    for method in ("auto", "gauss16", "dop853"):
        table = throw.run(2.0, method=method, events=["z"]).events
        # Round-off of some steps.
        assert table.t == pytest.approx([2.0], abs=1e-14)
        assert len(throw.run(1.999, method=method, events=["z"]).events) == 0
    assert len(oscillator().run(0.0, events=["q"]).events) == 0


def test_tables_are_what_those_of_scenes_are() -> None:
    out = vv.systems.henon_heiles().run(30.0, events=["x", events.coordinate("y", 0.1)])
    table = out.events
    assert len(table) == len(table.of(0)) + len(table.of(1))
    assert len(table[table.t < 10.0]) < len(table)
    assert [event.kind for event in table.definitions] == ["coordinate", "coordinate"]
    again = pickle.loads(pickle.dumps(out)).events
    assert np.array_equal(again.t, table.t)
    # A function of one's own goes nowhere; its name does.
    own = vv.systems.pendulum(position=[1.0]).run(5.0, events=[speed, events.function(lambda t, q, v: q[0])])
    first, second = pickle.loads(pickle.dumps(own)).events.definitions
    assert first.parameters == (("name", "speed"),)
    assert "<lambda>" in dict(second.parameters)["name"]
    for event in (first, second):
        with pytest.raises(vv.InvalidInput, match="a run keeps its name alone; give it again"):
            vv.systems.pendulum(position=[1.0]).run(1.0, events=[event])
    assert table.to_xarray().momentum.dims == ("event", "coordinate")
    assert len(table.to_pandas()) == len(table)
    assert f"Events: {len(table)}" in table._repr_html_()
    assert repr(table).startswith(f"GeneralizedEventTable({len(table)} events, 2 coordinates")
    for call, message in (
        (lambda: table[0], "index: expected a slice"),
        (lambda: vv.systems.pendulum(position=[1.0]).run(1.0).events, "no events were looked for"),
    ):
        with pytest.raises(vv.InvalidInput, match=message):
            call()
    with pytest.raises(TypeError, match="which, t, position, velocity, momentum, member"):
        iter(table)


@pytest.mark.parametrize("method", ["gauss16", "gauss4", "dop853", "taylor"])
@pytest.mark.parametrize("offset", [0.0, 1e6])
def test_no_motion_passes_the_energy_that_it_conserves(method: str, offset: float) -> None:
    """What passes E = E(0) is rounding, and errors of the method."""
    pendulum = vv.Lagrangian(
        lambda q, v, t: v @ v / 2 + np.cos(q[0]) - offset, ["theta"], position=[1.3], velocity=[0.2]
    )
    out = pendulum.run(20.0, method=method, events=[events.energy(pendulum.energy), "theta"])
    assert len(out.events.of(0).t) == 0
    assert len(out.events.of(1).t) > 3
    copies = pendulum.ensemble(position=[[1.3], [0.4]]).run(
        20.0, method=method, events=[events.energy(pendulum.energy)]
    )
    assert len(copies.events.t) == 0


def test_an_energy_that_is_lost_passes_that_of_a_while_later() -> None:
    """With drag the same event is there: conservation is what takes it away, and no nearness of values."""
    slowed = vv.Lagrangian(
        lambda q, v, t: v @ v / 2, ["x"], position=[0.0], velocity=[1.0], dissipation=lambda q, v, t: v @ v / 2
    )
    out = slowed.run(1.0, events=[events.energy(0.5 * (1 - 1e-12))])
    # E = exp(−2 t)/2: at t = 5e-13.
    np.testing.assert_allclose(out.events.t, [5e-13], rtol=1e-3)


@pytest.mark.parametrize("method", ["auto", "taylor", "gauss16", "rk4", "dop853"])
def test_the_last_row_of_a_run_to_an_end_time_is_the_event(method: str) -> None:
    pendulum = vv.systems.pendulum(position=[1.0])
    how = {"dt": 0.01} if method == "rk4" else {}
    low = vv.events.coordinate("theta", 0.0, terminal=True)
    out = pendulum.run(10.0, method=method, events=[low], **how)
    assert list(out.t) == [0.0, out.final.t0]
    assert abs(out["theta"][-1]) < 1e-15  # of an angle of 1 at a speed of 3: one unit in its last place
    assert out.velocity[-1] == out.final.velocity
    # rtol = 1e-12 in some ten steps; of rk4 fifty steps of h = 0.01, h⁴ each.
    assert out.energy[-1] == pytest.approx(out.energy[0], rel=1e-7 if method == "rk4" else 1e-11, abs=0)
    assert len(pendulum.run([0.0, 10.0], method=method, events=[low], **how)) == 1
