"""What there is no memory for is refused by name; the process goes on."""

import subprocess
import sys

import numpy as np
import pytest

import visviva as vv

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="the limit of the address space is Linux's")

LIMIT = 3_000_000_000
CALLS = {
    "r": "vv.potentials.Yukawa(1.0, 1.0).value(wide(10**8))",
    "position": "vv.orbits.elements(1.0, wide(6_000_000, 3), wide(6_000_000, 3))",
    "true_anomaly": "vv.orbits.state(1.0, pericenter=wide(2 * 10**7), eccentricity=0.1)",
    "t": "vv.systems.pendulum().run(t=wide(13 * 10**7))",
    "t of copies": "vv.systems.pendulum().ensemble(position=np.ones((4, 1))).run(t=wide(13 * 10**7))",
    "t of a scene": "vv.problems.figure_eight().scene.run(t=wide(13 * 10**7))",
    "t that is no float64 yet": "vv.systems.pendulum().run(t=wide(4 * 10**8))",
    "t_eval": "vv.solve_ivp(lambda t, y: -y, (0, 1), np.ones(10**5), t_eval=np.linspace(0, 1, 10**6))",
}


@pytest.mark.parametrize("argument", CALLS)
def test_what_does_not_fit_is_refused_and_nothing_dies(argument: str) -> None:
    script = f"""
import resource
import numpy as np, visviva as vv
wide = lambda *shape: np.broadcast_to(1.5, shape)
resource.setrlimit(resource.RLIMIT_AS, ({LIMIT}, {LIMIT}))
try:
    {CALLS[argument]}
except (vv.InvalidInput, MemoryError) as error:
    print(type(error).__name__, "bytes" in str(error) and "available" in str(error))
print(vv.potentials.Yukawa(1.0, 1.0).value(1.0) > 0)
"""
    child = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False)
    assert child.returncode == 0, child.stderr
    assert child.stdout == "InvalidInput True\nTrue\n"


def test_the_bytes_that_are_missing_are_those_of_all_numbers_of_an_array() -> None:
    """Eight for each of 3 · 10¹⁴ numbers: more than addresses reach."""
    from visviva._long_arrays import as_float64

    lent = np.lib.stride_tricks.as_strided(np.zeros(1, np.float32), (3, 10**8, 10**6), (0, 0, 0))
    with pytest.raises(vv.InvalidInput, match=r"^t: a copy of it would take 2400000000000000 bytes, which are not"):
        as_float64("t", lent)
