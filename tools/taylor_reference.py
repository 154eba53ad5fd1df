"""Reference states of plane gravity by Taylor series in decimal arithmetic: ``python tools/taylor_reference.py``.

Two orders, 34 and 40, in 50 digits: what they agree on is the reference, of the float64 numbers that the scene has. It
prints the states of `visviva.problems.arenstorf` as `visviva._reference_states` has them.
Source: Hairer, Nørsett & Wanner, *Solving ODE I*, II.8 (recurrences of Taylor series).
"""

from decimal import Decimal, getcontext

import visviva as vv

getcontext().prec = 50
TOLERANCE = Decimal(10) ** -38
Rows = list[list[Decimal]]


def product(a: list[Decimal], b: list[Decimal], k: int) -> Decimal:
    """The coefficient of tᵏ in a product of series."""
    return sum((a[n] * b[k - n] for n in range(k + 1)), Decimal(0))


def series(mass: list[Decimal], x: Rows, v: Rows, order: int) -> tuple[list[Rows], list[Rows]]:
    """Taylor coefficients of places and velocities, body by body and axis by axis."""
    places = [[[c] for c in row] for row in x]
    rates = [[[c] for c in row] for row in v]
    bodies = range(len(mass))
    pairs = {(i, j): ([], [], [], []) for i in bodies for j in range(i)}
    power = Decimal(-3) / 2
    for k in range(order):
        pulls = [[Decimal(0), Decimal(0)] for _ in bodies]
        for (i, j), (dx, dy, square, cube) in pairs.items():
            dx.append(places[j][0][k] - places[i][0][k])
            dy.append(places[j][1][k] - places[i][1][k])
            square.append(product(dx, dx, k) + product(dy, dy, k))
            if k == 0:
                cube.append(1 / (square[0] * square[0].sqrt()))
            else:
                # u = s^(−3/2) has s u' = −3/2 s' u.
                terms = ((power * (k - n) - n) * square[k - n] * cube[n] for n in range(k))
                cube.append(sum(terms, Decimal(0)) / (k * square[0]))
            for axis, apart in enumerate((dx, dy)):
                pull = product(apart, cube, k)
                pulls[i][axis] += mass[j] * pull
                pulls[j][axis] -= mass[i] * pull
        for body in bodies:
            for axis in (0, 1):
                places[body][axis].append(rates[body][axis][k] / (k + 1))
                rates[body][axis].append(pulls[body][axis] / (k + 1))
    return places, rates


def run(scene: vv.Scene, end: float, order: int) -> Rows:
    """Places at the end, of a scene in the plane with G = 1."""
    bodies = scene.particles
    mass = [Decimal(m) for m in bodies.mass.tolist()]
    x, v = ([[Decimal(c) for c in row[:2]] for row in rows.tolist()] for rows in (bodies.position, bodies.velocity))
    left = Decimal(end)
    while left > 0:
        places, rates = series(mass, x, v, order)
        sizes = ((abs(row[k]), k) for body in places for row in body for k in (order - 1, order))
        step = min(((TOLERANCE / size) ** (Decimal(1) / k) for size, k in sizes if size), default=left)
        step = min(step * Decimal("0.9"), left)
        x, v = ([[horner(axis, step) for axis in body] for body in part] for part in (places, rates))
        left -= step
    return x


def horner(coefficients: list[Decimal], t: Decimal) -> Decimal:
    """The sum of a series."""
    value = Decimal(0)
    for coefficient in reversed(coefficients):
        value = value * t + coefficient
    return value


if __name__ == "__main__":
    problem = vv.problems.arenstorf()
    low, high = (run(problem.scene, problem.t_end, order) for order in (34, 40))
    apart = max(abs(a - b) for one, other in zip(low, high, strict=True) for a, b in zip(one, other, strict=True))
    for row in high:
        print("    (" + ", ".join(f"{c:.30f}" for c in row) + ", 0.0),")
    print(f"# orders 34 and 40 are {apart:.1e} apart")
