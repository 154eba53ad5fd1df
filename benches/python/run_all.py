"""Run every comparison in turn and write ``RESULTS.md`` beside this file: ``python benches/python/run_all.py``."""

from __future__ import annotations

import subprocess
import sys
from datetime import UTC, datetime
from pathlib import Path

HERE = Path(__file__).parent
SCRIPTS = (
    "direct_gravity",
    "deflection",
    "pair_potentials",
    "leapfrog_step",
    "dop853_outer_solar_system",
    "round_off_floor",
    "energy_growth",
    "energy_growth_henon_heiles",
    "massless",
    "outputs",
    "energy_column",
    "events",
    "figure_eight_ensemble",
    "rigid",
    "rigid_scene",
    "rutherford",
    "same_bits",
    "solve_ivp",
    "overhead",
    "work_precision",
)


def main() -> int:
    """Number of scripts that failed to run; a missed bar is a result, not a failure."""
    sections, failed = [], 0
    for name in SCRIPTS:
        path = HERE / f"{name}.py"
        if not path.exists():
            sections.append(f"## {name}\n\nNot in this checkout.\n")
            continue
        done = subprocess.run([sys.executable, str(path)], stdout=subprocess.PIPE, text=True, check=False)
        failed += done.returncode != 0
        print(done.stdout, flush=True)
        sections.append(done.stdout if done.returncode == 0 else f"## {name}\n\nFailed with {done.returncode}.\n")
    head = (
        "# Results\n\nWritten by `python benches/python/run_all.py` "
        f"on {datetime.now(UTC):%Y-%m-%d}. Both sides of every row ran in turns in one run; least of several "
        "repeats. Ratios are what counts: the machine has neighbors.\n"
    )
    (HERE / "RESULTS.md").write_text("\n".join([head, *sections]))
    return failed


if __name__ == "__main__":
    sys.exit(main())
