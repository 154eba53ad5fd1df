"""Foils whose atoms have wells: ψ(b) has a hump at a rainbow, and all that turn by an angle are on its disc."""

import numpy as np
import pytest

import visviva as vv

S = vv.scattering
P = vv.potentials
MASSES = (1.008, 12.0)
DEPTH = 64.0
# Of relative motion, as a part of the energy in the laboratory.
SHARE = MASSES[1] / (MASSES[0] + MASSES[1])


@pytest.mark.parametrize(
    ("potential", "parts", "angle"),
    [
        # Below a rainbow, and below where orbits are; the parts of the depth of the well that energies are.
        (P.Morse(DEPTH, 2.0, 1.5), 0.5, 2.5),
        (P.Morse(DEPTH, 2.0, 1.5), 0.5, 3.0),
        (P.Morse(DEPTH, 2.0, 1.5), 1.0, 1.3),
        (P.LennardJones(DEPTH, 1.5), 0.8, 2.0),
        (P.LennardJones(DEPTH, 1.5), 0.8, 3.0),
        (P.LennardJones(DEPTH, 1.5), 3.0, 0.7),
        (P.SquareWell(DEPTH, 1.5), 1.0, 1.2),
    ],
    ids=lambda value: str(value) if isinstance(value, float) else type(value).__name__,
)
def test_forced_collisions_near_a_rainbow(potential: vv.potentials.Potential, parts: float, angle: float) -> None:
    energy = parts * DEPTH
    # An ångström of so few atoms is a single collision.
    material = S.Material(0.01, 6, MASSES[1])
    foil = S.Foil(material, 1e-4, potential=potential, stopping="none", minimum_angle=1e-3)
    out = foil.run(
        S.Ion(1, MASSES[0]),
        beam_energy=energy / SHARE,
        n_events=40_000,
        seed=5,
        collisions="single",
        forced_angle=angle,
        tally={"cm_angle": [angle, np.pi]},
    )
    value, error = out["cm_angle"].fraction()
    expected = S.total_cross_section(potential, energy=energy, theta_min=angle) * material.number_density
    assert abs(value[0] - expected) < 4.0 * error[0]
    assert error[0] < 0.05 * expected


def test_the_disc_of_a_minimum_angle_holds_the_rainbow() -> None:
    """Collisions across: density times thickness times the area of the outermost b that turns by as much."""
    well = P.LennardJones(50.0, 1.0)
    material = S.Material(0.1, 6, 12.0)
    energy = 300.0 * 12.0 / (12.0 + 1e-4)
    for angle in (0.30, 0.33, 0.345):
        foil = S.Foil(material, 1e-4, potential=well, stopping="none", minimum_angle=angle)
        with pytest.warns(vv.AccuracyWarning, match="thickness"):  # an ångström, so that the figure is the area
            out = foil.run(S.Ion(1, 1e-4), beam_energy=300.0, lowest_energy=299.0, n_events=100, seed=1)
        b = np.linspace(0.8, 3.0, 4001)
        turned = np.abs(S.deflection_angle(well, energy=energy, impact_parameter=b)) >= angle
        area = np.pi * b[turned].max() ** 2
        least = area * material.number_density
        # A few percent more than need be, no less.
        assert 0.99 * least < out.collisions_across < 1.1 * least
