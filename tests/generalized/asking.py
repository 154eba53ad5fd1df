"""What tests ask of a system beside its runs."""

from typing import Any

import numpy as np
from numpy.typing import NDArray


def rates(system: Any, t: float, position: Any, second: Any) -> NDArray[np.float64]:
    """Accelerations of a Lagrangian (of a Hamiltonian: rates, or forces where q̇ = p) at a state."""
    state = np.concatenate([np.asarray(position, dtype=float), np.asarray(second, dtype=float)])
    found: NDArray[np.float64] = system._model.rates(np.array([t]), state[None, :], system._values[None, :])[0]
    return found
