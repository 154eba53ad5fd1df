"""The table of figures in the README, from what the benches wrote into RESULTS.md.

    python tools/readme_figures.py [--check]

No figure is typed: each row of the README names rows of RESULTS.md by a pattern, and takes numbers out of their cells.
"""

from __future__ import annotations

import argparse
import re
import sys
from pathlib import Path

ROOT = Path(__file__).parents[1]
README = ROOT / "README.md"
RESULTS = ROOT / "benches" / "python" / "RESULTS.md"
BEGIN = "<!-- figures: tools/readme_figures.py writes them from benches/python/RESULTS.md -->\n"
END = "<!-- end of figures -->\n"
NUMBER = r"[\d.]+(?:e[+-]?\d+)?"


class Results:
    """Sections of RESULTS.md: their rows of cells, and the machine that each names."""

    def __init__(self, text: str) -> None:
        self.rows: dict[str, list[list[str]]] = {}
        self.machines: dict[str, str] = {}
        for section in re.split(r"^## ", text, flags=re.MULTILINE)[1:]:
            title = section.partition("\n")[0]
            lines = [line for line in section.splitlines() if line.startswith("| ")]
            self.rows[title] = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]
            if found := re.search(r"^Machine: (.*?);", section, flags=re.MULTILINE):
                self.machines[title] = found[1]

    def cells(self, section: str, what: str, column: int) -> list[str]:
        """Of all rows whose name matches, a cell: 1 is ours, 2 the peer's, 3 the ratio."""
        found = [row[column] for row in self.rows.get(section, []) if re.search(what, row[0])]
        if not found:
            sys.exit(f"RESULTS.md has no row {what!r} in {section!r}")
        return found

    def number(self, section: str, what: str, column: int, pattern: str, form: str) -> str:
        """The largest of the numbers that stand where the pattern says, in the rows that match."""
        values = []
        for cell in self.cells(section, what, column):
            found = re.search(pattern.replace("#", f"({NUMBER})"), cell)
            if found is None:
                sys.exit(f"RESULTS.md: {what!r} in {section!r} reads {cell!r}, expected {pattern!r}")
            values.append(float(found[1]))
        return re.sub(r"e([+-])0", r"e\1", format(max(values), form))


def table(results: Results) -> str:
    """The block between the marks."""
    n = results.number
    gravity, floor, start = "Direct gravity", "Round-off floor of Kahan–Li 8", "Initial value problems"
    tiers = {"avx512": "AVX-512", "avx2": "AVX2"}
    measured = [tier for tier in tiers if any(f"one thread, {tier};" in row[0] for row in results.rows[gravity])]
    best, *others = [f"N = 4096, one thread, {tier};" for tier in measured]
    ours = f"{n(gravity, best, 1, '# ns', '.2g')} ns per ordered pair ({tiers[measured[0]]})"
    for tier, what in zip(measured[1:], others, strict=True):
        ours += f", {n(gravity, what, 1, '# ns', '.2g')} ({tiers[tier]})"
    dop853, equal = "DOP853 on the outer Solar System", "SciPy in NumPy"
    kahan, stormer, saba = r"^step (36.5|29.2|25|20|14.6|10|7.3) d", "^stormer13", "best of REBOUND's"
    outputs = r"2 steps per output, on nodes \(1001"
    python, heyoka = "Arenstorf.*SciPy in Python", "Arenstorf.*heyoka"
    eights, moment = "Ensemble of figure-eights", "Overhead"
    microseconds = float(n(start, "Arenstorf", 1, "# µs", ".3g"))
    rows = [
        ("direct gravity, N = 4096, one thread", ours, f"REBOUND {n(gravity, best, 2, '#', '.2g')}"),
        (
            "leapfrog, 6 bodies",
            f"{n('A leapfrog step', 'N = 6', 1, '# ns', '.3g')} ns per step",
            f"REBOUND {n('A leapfrog step', 'N = 6', 2, '#', '.3g')}",
        ),
        (
            "DOP853, outer Solar System, 1e6 d, rtol 1e-13",
            f"{n(dop853, equal, 1, '# ms', '.2g')} ms, {n(dop853, equal, 1, 'error #', '.2g')} AU",
            f"SciPy {n(dop853, equal, 2, '# ms', '.4g')} ms, {n(dop853, equal, 2, 'error #', '.2g')} AU",
        ),
        (
            "Kahan–Li 8, outer Solar System, 3.65e6 d, steps of 7 to 36 d",
            f"at most {n(floor, kahan, 1, '^# AU', '.2g')} AU, energy {n(floor, kahan, 1, 'E #', '.2g')}",
            f"REBOUND SABA(10,6,4) {n(floor, saba, 2, '^# AU', '.2g')} AU, {n(floor, saba, 2, ', #', '.2g')}",
        ),
        (
            "Störmer 13, the same, steps of 7 to 20 d",
            f"at most {n(floor, stormer, 1, '^# AU', '.2g')} AU, energy {n(floor, stormer, 1, 'E #', '.2g')}",
            "the same",
        ),
        (
            "1001 outputs of 2000 leapfrog steps",
            f"{n('Outputs', outputs, 1, ': # ×', '.3g')} × the time without",
            f"REBOUND {n('Outputs', outputs, 2, '# ×', '.3g')} ×",
        ),
        (
            "100 apsides located in 2 bodies' orbits",
            f"{n('Events', 'two bodies, dop853, apsides', 1, ': # ×', '.3g')} × the time without (DOP853), "
            f"{n('Events', 'two bodies, leapfrog, apsides', 1, ': # ×', '.3g')} × (leapfrog)",
            "",
        ),
        (
            "`solve_ivp`, Arenstorf's orbit to 1e-6, numba `@cfunc`",
            f"{microseconds / 1e3:.2g} ms",
            f"SciPy in Python {n(start, python, 2, '# ms', '.2g')} ms, "
            f"heyoka {float(n(start, heyoka, 2, '# µs', '.3g')) / 1e3:.2g} ms",
        ),
        (
            "10⁴ figure-eights to t = 50 at 1e-9, two threads",
            f"{n(eights, '^stormer13, dt', 1, '# s', '.2g')} s (Störmer 13), "
            f"{n(eights, '^kahan_li8', 1, '# s', '.2g')} s (Kahan–Li 8)",
            f"heyoka batches of 4: {n(eights, '^heyoka batch of 4', 2, '# s', '.2g')} s; "
            f"of 8: {n(eights, '^heyoka batch of 8', 2, '# s', '.2g')} s",
        ),
        ("a Kepler orbit at one time", f"{n(moment, 'Kepler', 1, '# µs', '.2g')} µs per call", ""),
    ]
    used = (gravity, "A leapfrog step", dop853, floor, "Outputs", "Events", start, eights, moment)
    machines = sorted({results.machines[section] for section in used})
    lines = [
        "| what | visviva | peer |",
        "|---|---|---|",
        *(f"| {' | '.join(row)} |".replace("  ", " ") for row in rows),
    ]
    return "\n".join(lines) + f"\n\nMachine: {'; '.join(machines)}.\n"


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--check", action="store_true", help="say whether the README has them, and write nothing")
    asked = parser.parse_args()
    readme = README.read_text(encoding="utf-8")
    before, begin, rest = readme.partition(BEGIN)
    _, end, after = rest.partition(END)
    if not begin or not end:
        sys.exit("README.md has no marks around its figures")
    written = f"{before}{begin}\n{table(Results(RESULTS.read_text(encoding='utf-8')))}\n{end}{after}"
    if asked.check:
        if written != readme:
            sys.exit("README.md has other figures than RESULTS.md; run tools/readme_figures.py")
    elif written != readme:
        README.write_text(written, encoding="utf-8")


if __name__ == "__main__":
    main()
