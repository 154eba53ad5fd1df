"""Many angles of one potential and energy: what each has alone, to the bit, by any number of threads."""

import numpy as np
import pytest

import visviva as vv

S, P = vv.scattering, vv.potentials
ANGLES = np.concatenate([[0.0, 1e-9], np.linspace(0.05, 3.1, 5), [np.pi]])
CASES = {
    "orbiting": (P.LennardJones(1.0, 1.0), 0.5),
    "two barriers": (P.Custom(lambda r: 2.0 / r**12 - 1.0 / r**6 - 3.0 / r**4), 1.0),
    "capture": (P.PowerLaw(-1.0, 3), 1.0),
    "wall": (P.SoftSphere(1.0, 1.0, 2.5), 0.7),
}


@pytest.mark.parametrize(("potential", "energy"), CASES.values(), ids=CASES)
def test_many_angles_are_each_alone(potential: P.Potential, energy: float, monkeypatch: pytest.MonkeyPatch) -> None:
    def found() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        lab = S.cross_section(potential, energy=energy, angle=ANGLES, frame="lab", mass_ratio=0.5)
        return (
            S.cross_section(potential, energy=energy, angle=ANGLES),
            S.impact_parameter(potential, energy=energy, angle=ANGLES),
            lab,
        )

    together = found()
    for at, angle in enumerate(ANGLES):
        assert S.cross_section(potential, energy=energy, angle=angle) == together[0][at]
        alone = S.impact_parameter(potential, energy=energy, angle=angle)
        row = together[1][at]
        assert (alone == row[: alone.size]).all()
        assert np.isnan(row[alone.size :]).all()
    for threads in ("1", "3"):
        monkeypatch.setenv("VISVIVA_THREADS", threads)
        assert all(np.array_equal(a, b, equal_nan=True) for a, b in zip(found(), together, strict=True))
