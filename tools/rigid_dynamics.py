"""Write tests/rigid/dynamics_reference.json: the motion of scenes with rigid bodies, by extrapolation in 40 digits.

    python tools/rigid_dynamics.py [case …]

Each case is integrated twice, with tolerances 1e-24 and 1e-20 of a step: what is written agrees in both.
"""

import json
import sys
from pathlib import Path
from typing import Any

RIGID = Path(__file__).parents[1] / "tests" / "rigid"
sys.path.insert(0, str(RIGID))

import dynamics_cases  # noqa: E402
import mpmath  # noqa: E402
import reference_dynamics  # noqa: E402

FILE = RIGID / "dynamics_reference.json"


def motion(case: dict[str, Any]) -> dict[str, Any]:
    """The states at its times."""
    with mpmath.workdps(40):
        world, states = reference_dynamics.by_extrapolation(case)
        _, coarser = reference_dynamics.by_extrapolation(case, tolerance=1e-20)
        apart = max(
            abs(a - b) / max(1, abs(a)) for y, z in zip(states, coarser, strict=True) for a, b in zip(y, z, strict=True)
        )
        if apart > 1e-17:
            raise AssertionError(f"the two integrations are {float(apart)} apart")
        return reference_dynamics.by_columns(world, states)


def main() -> None:
    known = json.loads(FILE.read_text(encoding="utf-8")) if FILE.exists() else {}
    wanted = sys.argv[1:] or list(dynamics_cases.CASES)
    for name in wanted:
        case = dynamics_cases.CASES[name]
        known[name] = {"case": case, "states": motion(case)}
        print(name)
    kept = {name: known[name] for name in dynamics_cases.CASES if name in known}
    FILE.write_text(json.dumps(kept, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
