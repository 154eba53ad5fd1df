"""Instructions of each kernel and step, counted by callgrind, against those recorded.

A rewrite that slows a kernel shows here, whatever else the machine does. Each case of ``benches/rust/src/count.rs``
runs at two sizes; the difference, divided by the steps that the larger takes more, is recorded in
``instructions.json``. Callgrind knows AVX2 but not AVX-512, so the tier is AVX2.

    python benches/instructions.py            compare with what is recorded; fails above 1.05
    python benches/instructions.py step/      the cases with that in their name
    python benches/instructions.py --record   record this build
    python benches/instructions.py --record --because "reason" NAME   one line anew, for a cost that is meant

The bench is built without link-time optimization in one codegen unit, so that what is inlined does not depend on how
the crate is divided.
"""

from __future__ import annotations

import argparse
import json
import os
import re
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

TOP = Path(__file__).resolve().parents[1]
FILE = Path(__file__).with_suffix(".json")
LIMIT = 1.05
PROFILE = {
    "CARGO_PROFILE_RELEASE_LTO": "off",
    "CARGO_PROFILE_RELEASE_CODEGEN_UNITS": "1",
    "CARGO_PROFILE_RELEASE_DEBUG": "0",
}


def build() -> Path:
    target = Path(os.environ.get("CARGO_TARGET_DIR", TOP / "target")) / "instructions"
    command = ["cargo", "build", "--release", "--quiet", "--package", "visviva-benches", "--target-dir", str(target)]
    environment = {**os.environ, **PROFILE}
    environment.pop("RUSTFLAGS", None)
    subprocess.run(command, cwd=TOP, env=environment, check=True)
    return target / "release" / "visviva-benches"


def instructions(binary: Path, name: str, size: int) -> tuple[int, int]:
    """Instructions of the whole program, and the units of work that it did."""
    with tempfile.TemporaryDirectory() as folder:
        command = ["valgrind", "--tool=callgrind", f"--callgrind-out-file={folder}/out"]
        done = subprocess.run(
            [*command, str(binary), "count", name, str(size)],
            env={**os.environ, "VISVIVA_SIMD": "avx2", "VISVIVA_THREADS": "1"},
            capture_output=True,
            text=True,
            check=True,
        )
    found = re.search(r"Collected : (\d+)", done.stderr)
    if found is None or not done.stdout.strip():
        raise RuntimeError(f"{name}: {done.stderr[-500:]}")
    return int(found[1]), int(done.stdout)


def per_unit(binary: Path, name: str, small: int, large: int) -> float:
    (less, few), (more, many) = instructions(binary, name, small), instructions(binary, name, large)
    return (more - less) / (many - few)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("name", nargs="?", default="", help="cases with this in their name")
    parser.add_argument("--record", action="store_true")
    parser.add_argument("--because", default="", help="why a recorded count is replaced")
    parser.add_argument("--binary", type=Path, help="a bench that is built already")
    asked = parser.parse_args()
    recorded = json.loads(FILE.read_text()) if FILE.exists() else {}
    if asked.record and recorded and not asked.because:
        parser.error("--record replaces what is recorded: say why with --because")
    binary = asked.binary or build()
    listed = subprocess.run([str(binary), "count"], capture_output=True, text=True, check=True).stdout.split()
    sizes = {name: (int(a), int(b)) for name, a, b in zip(*[iter(listed)] * 3, strict=True) if asked.name in name}
    with ThreadPoolExecutor(int(os.environ.get("VISVIVA_BENCH_JOBS", "1"))) as pool:
        counts = dict(zip(sizes, pool.map(lambda name: per_unit(binary, name, *sizes[name]), sizes), strict=True))
    slower = []
    for name, count in counts.items():
        before = recorded.get(name, {}).get("instructions")
        ratio = count / before if before else float("nan")
        if before and ratio > LIMIT:
            slower.append(name)
        print(f"{name:34} {count:14.1f}  {'' if before is None else f'{before:14.1f}  × {ratio:.3f}'}")
    if asked.record:
        reason = {"because": asked.because} if asked.because else {}
        recorded |= {name: {"instructions": round(count, 1), **reason} for name, count in counts.items()}
        lines = ",\n".join(f"{json.dumps(name)}: {json.dumps(entry)}" for name, entry in recorded.items())
        FILE.write_text(f"{{\n{lines}\n}}\n")
        return
    missing = [name for name in recorded if asked.name in name and name not in counts]
    if missing:
        print(f"recorded, but no longer counted: {', '.join(missing)}")
    if slower or missing:
        sys.exit(f"more than {LIMIT} × the instructions recorded: {', '.join(slower) or 'none'}")


if __name__ == "__main__":
    main()
