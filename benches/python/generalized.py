"""Lagrangians and Hamiltonians against heyoka and SciPy with numba, in one run, at no larger error.

    python generalized.py [--quick]

Rows: one trajectory of each kind; ensembles; the time from an expression to its first step. Caches of heyoka are off,
and its compilation is not counted but where that is the row. Errors are against states of 25 and more digits.
"""

from __future__ import annotations

import json
import sys
import time
from pathlib import Path

import numpy as np

import visviva as vv

REFERENCE = Path(__file__).resolve().parents[2] / "tests/generalized/reference.json"


def best(work, repeats: int = 7) -> float:
    """The shortest of several times, in seconds."""
    times = []
    for _ in range(repeats):
        begin = time.perf_counter()
        work()
        times.append(time.perf_counter() - begin)
    return min(times)


def chain_heyoka(n: int):
    """heyoka's equations of a chain of unit masses and links."""
    import heyoka as hy

    q = hy.make_vars(*[f"q{i}" for i in range(n)])
    v = hy.make_vars(*[f"v{i}" for i in range(n)])
    q, v = (q, v) if n > 1 else ([q], [v])
    kinetic, potential, vx, vy, height = 0.0, 0.0, 0.0, 0.0, 0.0
    for angle, rate in zip(q, v, strict=True):
        vx = vx + hy.cos(angle) * rate
        vy = vy + hy.sin(angle) * rate
        height = height + hy.cos(angle)
        kinetic = kinetic + 0.5 * (vx * vx + vy * vy)
        potential = potential - 9.81 * height
    return hy.lagrangian(kinetic - potential, q, v), q, v


def systems() -> dict[str, tuple]:
    """Name: system, start, end, heyoka's equations."""
    import heyoka as hy

    x, y, px, py = hy.make_vars("x", "y", "px", "py")
    hamiltonian = 0.5 * (px * px + py * py) + 0.5 * (x * x + y * y) + x * x * y - y * y * y / 3.0
    henon_heiles = hy.hamiltonian(hamiltonian, [x, y], [px, py])
    chain = [0.5 + 0.0625 * k for k in range(10)]
    return {
        "pendulum, 3 rad, t = 100": (vv.systems.pendulum(position=[3.0]), 100.0, lambda: chain_heyoka(1)[0]),
        "double pendulum, t = 10": (
            vv.systems.double_pendulum(position=[0.5, 0.625]),
            10.0,
            lambda: chain_heyoka(2)[0],
        ),
        "double pendulum, wild, t = 10": (
            vv.systems.double_pendulum(position=[2.0, 2.5]),
            10.0,
            lambda: chain_heyoka(2)[0],
        ),
        "Hénon–Heiles, t = 100": (
            vv.systems.henon_heiles(position=[0.1, 0.0], momentum=[0.0, 0.5]),
            100.0,
            lambda: henon_heiles,
        ),
        "chain of 10, t = 10": (vv.systems.chain(10, position=chain), 10.0, lambda: chain_heyoka(10)[0]),
    }


def references() -> dict[str, np.ndarray]:
    """The states at the ends, where the file has them."""
    stored = json.loads(REFERENCE.read_text(encoding="utf-8"))["trajectories"]

    def at(name: str, t: float) -> np.ndarray:
        entry = stored[name]
        return np.array([float(value) for value in entry["y"][entry["t"].index(t)]])

    return {
        "double pendulum, t = 10": at("double_pendulum_moderate", 10.0),
        "double pendulum, wild, t = 10": at("double_pendulum_chaotic", 10.0),
        "Hénon–Heiles, t = 100": at("henon_heiles_float", 100.0),
        "chain of 10, t = 10": at("chain_10", 10.0),
    }


def single() -> None:
    """One trajectory of each kind."""
    import heyoka as hy

    known = references()
    print(f"{'one trajectory':<32} {'visviva':>10} {'error':>9} {'heyoka':>10} {'error':>9} {'ratio':>6}")
    for name, (system, end, equations) in systems().items():
        out = system.run(end)
        ours = best(lambda system=system, end=end: system.run(end))
        start = system._start()
        integrator = hy.taylor_adaptive(equations(), list(start), compact_mode=name.startswith("chain of 10"))

        def theirs_once(integrator=integrator, start=start, end=end) -> None:
            integrator.time = 0.0
            integrator.state[:] = start
            integrator.propagate_until(end)

        theirs = best(theirs_once)
        reference = known.get(name)
        if reference is None:
            reference = system.run(end, rtol=1e-14, max_step=0.02)._states[-1]
        errors = [np.abs(state - reference).max() for state in (out._states[-1], integrator.state)]
        print(
            f"{name:<32} {1e6 * ours:8.0f} µs {errors[0]:9.1e} {1e6 * theirs:8.0f} µs {errors[1]:9.1e} "
            f"{theirs / ours:6.2f}   {out.steps} steps, {out.evaluations} evaluations"
        )


def by_scipy() -> None:
    """The pendulum and the chain of ten by SciPy's DOP853 with rates that numba compiles, at no smaller error."""
    import numba
    from scipy.integrate import solve_ivp

    @numba.njit
    def pendulum(_, y):
        return np.array([y[1], -9.81 * np.sin(y[0])])

    @numba.njit
    def chain(_, y):
        n = len(y) // 2
        mass, right = np.empty((n, n)), np.zeros(n)
        for i in range(n):
            for j in range(n):
                below = n - max(i, j)
                mass[i, j] = below * np.cos(y[i] - y[j])
                right[i] -= below * np.sin(y[i] - y[j]) * y[n + j] ** 2
            right[i] -= 9.81 * (n - i) * np.sin(y[i])
        rates = np.empty(2 * n)
        rates[:n], rates[n:] = y[n:], np.linalg.solve(mass, right)
        return rates

    print(f"\n{'SciPy DOP853 with numba':<32} {'visviva':>11} {'error':>9} {'SciPy':>11} {'error':>9} {'ratio':>6}")
    all_systems = systems()
    for name, rate, rtol in (
        ("pendulum, 3 rad, t = 100", pendulum, 3e-14),
        ("chain of 10, t = 10", chain, 3e-14),
    ):
        system, end, _ = all_systems[name]
        start = system._start()
        reference = system.run(end, method="taylor", rtol=1e-15)._states[-1]
        ours = best(lambda system=system, end=end: system.run(end))

        def theirs_once(rate=rate, start=start, end=end, rtol=rtol):
            return solve_ivp(rate, (0.0, end), start, method="DOP853", rtol=rtol, atol=1e-15)

        theirs = best(theirs_once, 3)
        errors = [np.abs(y - reference).max() for y in (system.run(end)._states[-1], theirs_once().y[:, -1])]
        print(
            f"{name:<32} {1e6 * ours:8.0f} µs {errors[0]:9.1e} {1e6 * theirs:8.0f} µs {errors[1]:9.1e}"
            f" {theirs / ours:6.0f}"
        )


def ensembles(members: int) -> None:
    """Many trajectories on one thread, by Taylor series both; median errors against Gauss's method of order 16."""
    import heyoka as hy

    print(f"\n{f'{members} trajectories':<32} {'visviva':>10} {'error':>8} {'heyoka':>10} {'error':>8} {'ratio':>6}")
    rng = np.random.default_rng(1)
    for name, (system, end, equations) in systems().items():
        if "wild" in name or "chain" in name:
            continue
        starts = system._start() * (1.0 + 0.01 * rng.standard_normal((members, len(system._start()))))
        n = len(system.coordinates)
        second = "momentum" if isinstance(system, vv.Hamiltonian) else "velocity"
        many = system.ensemble(position=starts[:, :n], **{second: starts[:, n:]})

        exact = many.run(end)._states[:, -1]

        def error(states, exact=exact):
            return np.median(np.abs(states - exact).max(axis=1))

        def ours_once(many=many, end=end):
            return many.run(end, method="taylor", rtol=1e-14, threads=1)

        ours = best(ours_once, 2)
        integrator = hy.taylor_adaptive_batch(equations(), np.ascontiguousarray(starts[:8].T))

        def theirs_once(integrator=integrator, starts=starts, end=end):
            def begin(copy, i):
                copy.set_time(0.0)
                copy.state[:] = starts[8 * i : 8 * i + 8].T
                return copy

            return hy.ensemble_propagate_until_batch(integrator, end, len(starts) // 8, begin, max_workers=1)

        theirs = best(theirs_once, 2)
        reached = np.concatenate([each[0].state.T for each in theirs_once()])
        print(
            f"{name:<32} {1e6 * ours / members:8.1f} µs {error(ours_once()._states[:, -1]):8.1e}"
            f" {1e6 * theirs / members:8.1f} µs {error(reached):8.1e} {theirs / ours:6.2f}"
        )
    system, end, _ = systems()["Hénon–Heiles, t = 100"]
    many = system.ensemble(momentum=rng.uniform(-0.3, 0.3, (members, 2)))
    exact = many.run(end)._states[:, -1]

    def loose():
        return many.run(end, method="taylor", rtol=5e-9, threads=1)

    ours, worst = best(loose, 3), np.abs(loose()._states[:, -1] - exact).max()
    print(f"{'Hénon–Heiles, a worst error of':<32} {1e6 * ours / members:8.1f} µs {worst:8.1e}")


def by_sympy(L, angles, n: int) -> None:
    """SymPy's equations of motion, as a function of numbers, and one evaluation."""
    import sympy as sp
    from sympy.physics.mechanics import LagrangesMethod

    method = LagrangesMethod(L, angles)
    method.form_lagranges_equations()
    rates = [angle.diff(vv.time) for angle in angles]
    function = sp.lambdify([*angles, *rates], [method.mass_matrix, method.forcing], cse=True)
    mass, forcing = function(*[0.5] * n, *[0.0] * n)
    np.linalg.solve(np.asarray(mass, dtype=float), np.asarray(forcing, dtype=float))


def compilation() -> None:
    """From SymPy's expression to the first step."""
    import heyoka as hy
    import sympy as sp

    print(f"\n{'expression to first step':<32} {'visviva':>10} {'heyoka':>10} {'ratio':>6} {'SymPy':>10} {'ratio':>6}")
    for n in (2, 10):
        angles = [vv.coordinate(f"q{i}") for i in range(n)]
        rates = [angle.diff(vv.time) for angle in angles]
        L, vx, vy, height = 0, 0, 0, 0
        for angle, rate in zip(angles, rates, strict=True):
            vx, vy, height = vx + sp.cos(angle) * rate, vy + sp.sin(angle) * rate, height + sp.cos(angle)
            L = L + (vx**2 + vy**2) / 2 + 9.81 * height
        ours = best(lambda L=L, angles=angles, n=n: vv.Lagrangian(L, angles, position=[0.5] * n).run(1e-3))

        def theirs_once(n=n) -> None:
            equations = chain_heyoka(n)[0]
            hy.taylor_adaptive(equations, [0.5] * n + [0.0] * n, compact_mode=n > 2).step()

        theirs = best(theirs_once, 1)
        symbolic = best(lambda L=L, angles=angles, n=n: by_sympy(L, angles, n), 1)
        print(
            f"{f'chain of {n}':<32} {1e3 * ours:8.2f} ms {1e3 * theirs:8.1f} ms {theirs / ours:6.0f}"
            f" {1e3 * symbolic:8.0f} ms {symbolic / ours:6.0f}"
        )


def main() -> None:
    """All rows."""
    import heyoka as hy

    hy.llvm_state.set_diskcache_enabled(False)
    hy.llvm_state.set_memcache_limit(0)
    single()
    by_scipy()
    ensembles(160 if "--quick" in sys.argv[1:] else 2000)
    compilation()


if __name__ == "__main__":
    main()
