"""Conservation and invariants of what is beyond float64: infinite or not known, never a drift of zero."""

import numpy as np
import pytest

import visviva as vv

ROWS = ("energy", "momentum", "angular momentum", "center of mass")


def pair(mass: float, speed: float, *forces: vv.forces.Force) -> vv.Scene:
    bodies = vv.Particles([mass, mass], [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]], [[speed, 0.0, 0.0], [0.0, speed, 0.0]])
    return vv.Scene(bodies, *forces)


@pytest.mark.parametrize(
    ("mass", "speed", "known"),
    [
        (1.0, 1e200, {"momentum", "angular momentum", "center of mass"}),  # of an energy of 1e400
        (1e200, 1e100, {"momentum", "angular momentum", "center of mass"}),
        (1e200, 1e200, set()),  # of a momentum of 1e400, too
    ],
)
def test_rows_beyond_float64_are_not_known_and_the_others_are(mass: float, speed: float, known: set[str]) -> None:
    kept = pair(mass, speed).run(t=[0.0, 0.5, 1.0]).conservation()
    for name in ROWS:
        row = kept[name]
        if name in known:
            # Two free bodies: rounding of a few sums.
            assert row.max == pytest.approx(0.0, rel=0.0, abs=1e-15), name
        else:
            assert np.isnan([row.max, row.end, row.rms, row.slope]).all(), name
    # The rows that are not known say so in the table, and the others do not.
    told = {name: "nan" in line for name in ROWS for line in str(kept).splitlines() if line.strip().startswith(name)}
    assert told == {name: name not in known for name in ROWS}


def test_the_root_mean_square_of_drifts_whose_squares_overflow() -> None:
    """A center of mass that a spring holds back from a way of 1e200: of the drifts 0 and d it is d/√2."""
    row = pair(1e-200, 1e200, vv.Harmonic(1.0)).run(t=[0.0, 1.0]).conservation()["center of mass"]
    assert row.end > 1e199
    # Rounding of a root, a product and a quotient.
    assert row.rms == pytest.approx(row.end / np.sqrt(2.0), rel=1e-15, abs=0.0)


def test_an_energy_that_cancels_from_beyond_float64_has_no_relative_drift() -> None:
    """T = −V = 1e310: what is left of them is less than what their rounding leaves, and no zero."""
    bodies = vv.Particles([1e160], [[0.0, 0.0, -0.5]], [[1e75, 0.0, 0.0]])
    scene = vv.Scene(bodies, vv.UniformField([0.0, 0.0, -1e150]))
    start = scene.invariants()
    assert (start.kinetic_energy, start.potential_energy) == (np.inf, -np.inf)
    assert np.isnan(scene.run(t=[0.0, 1.0]).conservation()["energy"].max)


def test_copies_beyond_float64_beside_others() -> None:
    velocity = pair(1.0, 1.0).particles.velocity * np.reshape([1.0, 1e200], (2, 1, 1))
    kept = pair(1.0, 1.0).ensemble(velocity=velocity).run(t=[0.0, 1.0]).conservation()
    # Free bodies of speeds about 1: rounding of a sum of two squares.
    assert kept.energy.max[0] < 1e-15
    assert np.isnan(kept.energy.max[1])
    assert kept.energy.worst == 0


def test_a_momentum_whose_scale_is_beyond_float64_has_no_drift_of_zero() -> None:
    """Of opposite momenta of 1.5e308 each: their sum stays 0, and what it is measured by is no number."""
    bodies = vv.Particles(
        [1e200, 1e200], [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]], [[1.5e108, 0.0, 0.0], [-1.5e108, 0.0, 0.0]]
    )
    row = vv.Scene(bodies).run(t=[0.0, 1.0]).conservation()["momentum"]
    assert np.isnan([row.max, row.end]).all()


def test_the_energy_of_the_center_of_mass_is_known_where_the_square_of_the_momentum_is_not() -> None:
    """P²/2M of a momentum of 1.5e200 and a mass of 3e200: 3.75e199, without 2.25e400 on the way."""
    bodies = vv.Particles([1e200, 2e200], [[0.0, 0, 0], [1.0, 0, 0]], [[0.5, 0, 0], [0.5, 0, 0]])
    told = vv.Scene(bodies).invariants()
    # A few products, of numbers that are no powers of two.
    assert told.center_of_mass_kinetic_energy == pytest.approx(3.75e199, rel=1e-15, abs=0.0)
    assert told.internal_kinetic_energy == pytest.approx(0.0, rel=0.0, abs=1e-31 * 3.75e199)


def test_a_torque_beyond_float64_is_not_known() -> None:
    """1e160 at an arm of 1 in a field of 1e150, beside a body of 1: about y it is no number, about z it is 0."""
    bodies = vv.Particles([1e160, 1.0], [[1.0, 0.0, 0.0], [2.0, 0.0, 0.0]])
    told = vv.Scene(bodies, vv.UniformField([0.0, 0.0, -1e150])).invariants(about=[0.0, 0.0, 0.0]).torque
    assert np.isnan(told[1])
    assert told[2] == 0.0
