"""What Python takes of runs that take no time themselves, counted by calls: no clock is asked, which load misleads."""

from calls import python_calls

import visviva as vv

MASSES = [1.0, 2.0, 3.0]
PLACES = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
VELOCITIES = [[0.0, 0.0, 0.0], [0.0, 0.1, 0.0], [0.0, 0.0, 0.0]]


def test_particles_of_lists_are_made_in_few_calls() -> None:
    """39; what looked at arrays once more, and at their sums, took 61."""
    vv.Particles(MASSES, PLACES, VELOCITIES)
    assert python_calls(lambda: vv.Particles(MASSES, PLACES, VELOCITIES)) < 50


def test_a_run_in_generalized_coordinates_takes_few_calls() -> None:
    """38; arrays of one state, and of states that nobody asked for, took 45."""
    system = vv.systems.double_pendulum()
    system.run(t=1e-3)
    assert python_calls(lambda: system.run(t=1e-3)) < 42
