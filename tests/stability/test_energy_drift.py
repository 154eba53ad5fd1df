"""Round-off makes the energy of a symplectic run wander; it must not drift."""

import numpy as np

import visviva as vv


def test_the_energy_of_kahan_li_8_wanders_without_a_drift() -> None:
    """The mean over 32 copies stays within its own scatter, 1/√32 of that of a copy.

    Measured 1.2 of those; 9 when the low part of a coefficient is kept or lost depending on the state. The
    bits are the same on every machine, so the bound cannot fail by chance.
    """
    scene = vv.problems.outer_solar_system("applegate").scene
    noise = np.random.default_rng(0).standard_normal((2, 32, 6, 3)) * 1e-9
    copies = scene.ensemble(
        position=scene.particles.position * (1.0 + noise[0]), velocity=scene.particles.velocity * (1.0 + noise[1])
    )
    energy = copies.run([0.0, 1e7], method="kahan_li8", dt=25.0, record=("energy",)).energy
    change = energy[:, 1] / energy[:, 0] - 1.0
    scatter = change.std()
    assert scatter < 5e-15  # measured 3.0e-15 after 4e5 steps
    assert abs(change.mean()) < 3.0 * scatter / np.sqrt(len(change))
