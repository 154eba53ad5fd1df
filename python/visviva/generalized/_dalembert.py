"""d'Alembert's principle along a run: what the equations of motion leave does no work along virtual displacements."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from visviva.errors import InvalidInput
from visviva.generalized._calculus import Calculus
from visviva.generalized._trajectory import check_run

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from visviva.generalized._lagrangian import Lagrangian
    from visviva.generalized._trajectory import GeneralizedTrajectory

__all__ = ["dalembert"]

#: Rows of constraints shorter than this of the longest add no direction.
_DEPENDENT = 1e-12


def dalembert(system: Lagrangian, trajectory: GeneralizedTrajectory) -> NDArray[np.float64]:
    """Give the relative residual at each time."""
    check_run(trajectory)
    c, n = Calculus(system), len(system.coordinates)
    run = trajectory.system
    if run._source.kind != "lagrangian" or run.coordinates != system.coordinates:
        raise InvalidInput(
            "trajectory", f"expected a run of a Lagrangian of {list(system.coordinates)}, got {trajectory}"
        )
    description, t, states, values = system._source.description, trajectory.t, trajectory._states, run._values
    # d/dt ∂L/∂q̇ − ∂L/∂q − Q + ∂R/∂q̇, in parts: what it is made of tells its size.
    momenta, v = c.with_derivatives(c.of_system("conjugates")), c.velocities()
    parts = [
        [*(row[1 + j] * v[j] for j in range(n)), row[2 * n + 1], -slope]
        for row, slope in zip(momenta, c.of_system("slopes"), strict=True)
    ]
    if description["forces"]:
        for part, force in zip(parts, c.adopted(description["nodes"], description["forces"]), strict=True):
            part.append(-force)
    if description["dissipation"] is not None:
        row = c.with_derivatives(c.adopted(description["nodes"], [description["dissipation"]]))[0]
        for index, part in enumerate(parts):
            part.append(row[n + 1 + index])
    width = len(parts[0])
    known = c.values([each for part in parts for each in part], t, states, values).reshape(-1, n, width)
    mass = c.values([row[n + 1 + j] for row in momenta for j in range(n)], t, states, values).reshape(-1, n, n)
    accelerations = run._model.rates(np.ascontiguousarray(t), np.ascontiguousarray(states), values[None, :])
    terms = np.concatenate([known, mass * accelerations[:, None, :]], axis=2)
    reactions, sizes = terms.sum(axis=2), np.abs(terms).sum(axis=(1, 2))
    rows = [row[1 : n + 1] for row in c.with_derivatives(c.adopted(description["nodes"], description["holonomic"]))]
    rows += [
        row[n + 1 : 2 * n + 1]
        for row in c.with_derivatives(c.adopted(description["nodes"], description["nonholonomic"]))
    ]
    gradients = c.values([each for row in rows for each in row], t, states, values).reshape(len(t), len(rows), n)
    residual = np.empty(len(t))
    for index in range(len(t)):
        _, lengths, directions = np.linalg.svd(gradients[index])
        rank = int((lengths > _DEPENDENT * lengths.max(initial=0.0)).sum())
        work = np.abs(directions[rank:] @ reactions[index])
        residual[index] = work.max(initial=0.0) / sizes[index] if sizes[index] > 0.0 else 0.0
    residual.flags.writeable = False
    return residual
