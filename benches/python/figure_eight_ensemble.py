"""10^4 perturbed figure-eights to t = 50 at equal final error, against heyoka's batch ensemble.

Every method on either side is given the loosest setting whose final position error, rms over a subset of the
copies against an extended-precision reference, is at most 1e-9; then all copies are timed on two threads, in
turns. heyoka compiles before the clock starts; its copying of integrators is part of its ensembles and counts.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import heyoka
import numpy as np
from _harness import Row, faster, minima, report
from _reference import Reference, equations, flat

import visviva as vv

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from numpy.typing import NDArray

COPIES, SUBSET, END, TARGET, WORKERS = 10_000, 128, 50.0, 1e-9, 2

Setting = "Callable[[int], NDArray[np.float64]]"


def perturbed(scene: vv.Scene) -> vv.EnsembleScene:
    """Positions and velocities changed by normal numbers of 1e-3."""
    random = np.random.default_rng(1993)
    bodies = scene.particles
    return scene.ensemble(
        position=bodies.position + 1e-3 * random.normal(size=(COPIES, 3, 3)),
        velocity=bodies.velocity + 1e-3 * random.normal(size=(COPIES, 3, 3)),
    )


def heyoka_batch(ensemble: vv.EnsembleScene, batch: int, tolerance: float) -> Setting:
    """Final positions of the first ``count`` copies by ``ensemble_propagate_until_batch``."""
    starts = np.ascontiguousarray(flat(ensemble.position, ensemble.velocity).T)
    integrator = heyoka.taylor_adaptive_batch(equations(ensemble.scene), starts[:, :batch].copy(), tol=tolerance)

    def start(copy: heyoka.taylor_adaptive_batch, index: int) -> heyoka.taylor_adaptive_batch:
        copy.set_time(0.0)
        copy.state[:] = starts[:, index * batch : (index + 1) * batch]
        return copy

    def final(count: int) -> NDArray[np.float64]:
        done = heyoka.ensemble_propagate_until_batch(integrator, END, count // batch, start, max_workers=WORKERS)
        states = np.concatenate([result[0].state for result in done], axis=1)
        return states.T.reshape(count, 3, 6)[..., :3]

    return final


def ours(ensemble: vv.EnsembleScene, method: str, value: float) -> Setting:
    """Final positions by one of our methods; ``value`` is its rtol or its step."""
    small = ensemble.scene.ensemble(position=ensemble.position[:SUBSET], velocity=ensemble.velocity[:SUBSET])
    keyword = {"rtol": value} if method == "dop853" else {"dt": value}

    def final(count: int) -> NDArray[np.float64]:
        copies = ensemble if count == COPIES else small
        return copies.run(t=END, method=method, threads=WORKERS, record=("position",), **keyword).position[:, -1]

    return final


def loosest(
    make: Callable[[float], Setting], values: NDArray[np.float64], truth: NDArray[np.longdouble]
) -> tuple[float, Setting, float]:
    """First of ever tighter values whose rms error meets the target; the value, the setting, the error."""
    for value in values:
        setting = make(float(value))
        error = float(np.sqrt(((setting(SUBSET) - truth) ** 2).sum(axis=-1).mean()))
        if error <= TARGET:
            return float(value), setting, error
    raise RuntimeError("no value meets the target")


def rows() -> Iterator[Row]:
    ensemble = perturbed(vv.problems.figure_eight().scene)
    reference = Reference(ensemble.scene)
    truth = np.array([reference.positions(END, ensemble.position[i], ensemble.velocity[i]) for i in range(SUBSET)])
    tolerances = 10.0 ** -np.arange(9.2, 13.0, 0.05)
    candidates = {
        **{
            f"heyoka batch of {batch}": loosest(lambda x, b=batch: heyoka_batch(ensemble, b, x), tolerances, truth)
            for batch in (4, 8)
        },
        "dop853": loosest(lambda x: ours(ensemble, "dop853", x), 10.0 ** -np.arange(11.8, 13.5, 0.05), truth),
        # Yoshida 4 needs ten times the force evaluations of Kahan–Li 8 for this error.
        "kahan_li8": loosest(lambda x: ours(ensemble, "kahan_li8", x), 0.065 * 0.98 ** np.arange(30), truth),
        "stormer13": loosest(lambda x: ours(ensemble, "stormer13", x), 0.024 * 0.99 ** np.arange(60), truth),
    }
    seconds = dict(
        zip(candidates, minima(*(lambda s=s: s(COPIES) for _, s, _ in candidates.values()), repeats=5), strict=True)
    )
    batches = {batch: f"heyoka batch of {batch}" for batch in (4, 8)}
    mine = min((name for name in candidates if not name.startswith("heyoka")), key=seconds.__getitem__)
    for name, (value, _, error) in candidates.items():
        figures = f"{seconds[name]:.3f} s, error {error:.1e}"
        ours_here = not name.startswith("heyoka")
        kind = "tol" if not ours_here else ("rtol" if name == "dop853" else "dt")
        yield Row(
            f"{name}, {kind} = {value:.2e}", figures if ours_here else "", "" if ours_here else figures, "", "", None
        )
    for batch, theirs in batches.items():
        recommended = batch == heyoka.recommended_simd_size()
        yield faster(
            f"{mine} against {theirs}{', the size heyoka recommends here' if recommended else ''}",
            f"{seconds[mine]:.3f} s",
            f"{seconds[theirs]:.3f} s",
            seconds[theirs] / seconds[mine],
            15.0,
        )


if __name__ == "__main__":
    report(
        "Ensemble of figure-eights",
        rows(),
        f"{COPIES} copies to t = {END:g} on {WORKERS} threads; rms position error at most {TARGET:g} "
        f"over {SUBSET} copies.",
    )
