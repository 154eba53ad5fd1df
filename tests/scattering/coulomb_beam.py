"""The beam of the Monte Carlo's tests, its law, and every event of it once more in NumPy."""

import numpy as np

import visviva as vv

BEAM = {"beam_energy": 1.5, "masses": (1.0, 4.0), "b_max": 3.0, "seed": 20_260_101}
TALLIES = ["cm_angle", "lab_angle", "recoil_angle", "energy", "recoil_energy", "impact_parameter"]


def run(k: float = 2.0, **changes: object) -> vv.scattering.MonteCarlo:
    return vv.scattering.monte_carlo(vv.potentials.Coulomb(k), **{**BEAM, "n_events": 100_000, **changes})


def half_distance(k: float = 2.0) -> float:
    m1, m2 = BEAM["masses"]
    return k / (2.0 * BEAM["beam_energy"] * m2 / (m1 + m2))


def philox(key: tuple[int, int], counter: np.ndarray) -> np.ndarray:
    """Philox 4x32-10 of counters of shape (n, 4), from the paper of Salmon et al."""
    x = counter.astype(np.uint64).T.copy()
    low = np.uint64(0xFFFFFFFF)
    k = list(key)
    for _ in range(10):
        p0, p1 = x[0] * np.uint64(0xD2511F53), x[2] * np.uint64(0xCD9E8D57)
        x = np.stack(
            [(p1 >> np.uint64(32)) ^ x[1] ^ np.uint64(k[0]), p1 & low,
             (p0 >> np.uint64(32)) ^ x[3] ^ np.uint64(k[1]), p0 & low]
        )  # fmt: skip
        k = [(k[0] + 0x9E3779B9) & 0xFFFFFFFF, (k[1] + 0xBB67AE85) & 0xFFFFFFFF]
    return x.T


def uniforms(seed: int, first: int, count: int, draw: int = 0) -> np.ndarray:
    """A draw of each event: half a block, words low and high, its upper 53 bits."""
    events = np.arange(first, first + count, dtype=np.uint64)
    counter = np.zeros((count, 4), np.uint64)
    counter[:, 0], counter[:, 1] = (events >> np.uint64(1)) & np.uint64(0xFFFFFFFF), events >> np.uint64(33)
    counter[:, 2] = draw
    words = philox((seed & 0xFFFFFFFF, seed >> 32), counter)
    odd = (events & np.uint64(1)).astype(bool)
    low, high = np.where(odd, words[:, 2], words[:, 0]), np.where(odd, words[:, 3], words[:, 1])
    return ((high << np.uint64(32) | low) >> np.uint64(11)).astype(np.float64) * 2.0**-53


def event_by_event(uniform: np.ndarray, k: float = 2.0) -> dict[str, np.ndarray]:
    m1, m2 = BEAM["masses"]
    b = BEAM["b_max"] * np.sqrt(uniform)
    psi = 2.0 * np.arctan2(abs(half_distance(k)), b)
    taken = BEAM["beam_energy"] * 4.0 * m1 * m2 / (m1 + m2) ** 2 * np.sin(psi / 2.0) ** 2
    return {
        "cm_angle": psi,
        "lab_angle": np.arctan2(np.sin(psi), m1 / m2 + np.cos(psi)),
        "recoil_angle": (np.pi - psi) / 2.0,
        "energy": BEAM["beam_energy"] - taken,
        "recoil_energy": taken,
        "impact_parameter": b,
    }


def law(edges: np.ndarray, quantity: str, masses: tuple[float, float], kappa: float, energy: float) -> np.ndarray:
    """σ of each bin as the area of the impact parameters that lead there: b² at both edges, of one branch."""
    total = masses[0] + masses[1]
    with np.errstate(divide="ignore"):
        if quantity == "cm_angle":
            squares = kappa**2 / np.tan(edges / 2.0) ** 2
        elif quantity == "recoil_angle":
            squares = kappa**2 * np.tan(edges) ** 2
        elif quantity in ("energy", "recoil_energy"):
            taken = energy - edges if quantity == "energy" else edges
            share = taken / (energy * 4.0 * masses[0] * masses[1] / total**2)
            squares = kappa**2 * np.maximum(0.0, 1.0 / share - 1.0)
        elif quantity == "lab_angle":
            first, _ = vv.scattering.cm_angle(edges, mass_ratio=masses[0] / masses[1])
            squares = kappa**2 / np.tan(np.nan_to_num(first, nan=np.pi) / 2.0) ** 2
        else:
            squares = edges**2
    return np.pi * np.abs(np.diff(squares))
