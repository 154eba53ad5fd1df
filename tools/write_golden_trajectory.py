"""Write `tests/reference/trajectory_v1.npz`, once for a version of the format.

The file is a promise that later versions load it, so this script refuses to write over one. For a new format version,
add a new file beside it.
"""

from pathlib import Path

import visviva as vv
from visviva import io

TARGET = Path(__file__).parent.parent / "tests" / "reference" / f"trajectory_v{io.VERSION}.npz"


def main() -> None:
    if TARGET.exists():
        raise SystemExit(f"{TARGET} is there already, and stays as it is")
    scene = vv.Scene(
        vv.Particles([1.0, 0.5], [[0, 0, 0], [1, 0, 0]], [[0, 0, 0], [0, 1.2, 0]]),
        vv.Gravity(G=1.1, softening=0.01),
        vv.UniformField([0.1, 0.0, -0.2]),
        vv.CentralField(vv.potentials.Yukawa(k=0.1, length=3.0), center=[0.0, 0.0, 5.0]),
        t0=1.5,
    )
    record = ("position", "velocity", "energy")
    scene.run(t=[1.5, 2.0, 2.5, 3.0, 3.5], method="dop853", rtol=1e-12, record=record).save(TARGET)


if __name__ == "__main__":
    main()
