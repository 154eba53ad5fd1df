"""Particles and rigid bodies by the equations of motion themselves, in floats or in any number of digits.

Nothing here knows the package: tensors stay tensors along the body's own axes, a fixed point is a coordinate that is
left out, and a step is one of extrapolation (Gragg, Bulirsch, Stoer) with mpmath's numbers or of SciPy's DOP853.

A case is a dictionary: ``bodies`` and ``particles`` by the names of the arguments of `vv.RigidBodies` and
`vv.Particles`, ``forces`` as pairs of a name and its arguments, ``times``.
"""

from collections.abc import Callable, Sequence
from typing import Any

import mpmath
import numpy as np
from scipy.integrate import solve_ivp

Vector = list[Any]
ORIGIN = [0.0, 0.0, 0.0]


def add(a: Vector, b: Vector) -> Vector:
    return [x + y for x, y in zip(a, b, strict=True)]


def minus(a: Vector, b: Vector) -> Vector:
    return [x - y for x, y in zip(a, b, strict=True)]


def times(s: Any, a: Vector) -> Vector:
    return [s * x for x in a]


def dot(a: Vector, b: Vector) -> Any:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Vector, b: Vector) -> Vector:
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def apply(matrix: list[Vector], v: Vector) -> Vector:
    return [dot(row, v) for row in matrix]


def transposed(matrix: list[Vector]) -> list[Vector]:
    return [list(row) for row in zip(*matrix, strict=True)]


def product(a: list[Vector], b: list[Vector]) -> list[Vector]:
    return [apply(transposed(b), row) for row in a]


def inverse(m: list[Vector]) -> list[Vector]:
    """Of a symmetric matrix, by cofactors."""
    cofactors = [cross(m[1], m[2]), cross(m[2], m[0]), cross(m[0], m[1])]
    return [times(1 / dot(m[0], cofactors[0]), row) for row in cofactors]


def rotation(q: Vector) -> list[Vector]:
    """The matrix of a quaternion (x, y, z, w) of any length."""
    x, y, z, w = q
    s = 2 / (x * x + y * y + z * z + w * w)
    return [
        [1 - s * (y * y + z * z), s * (x * y - z * w), s * (x * z + y * w)],
        [s * (x * y + z * w), 1 - s * (x * x + z * z), s * (y * z - x * w)],
        [s * (x * z - y * w), s * (y * z + x * w), 1 - s * (x * x + y * y)],
    ]


def motor(t: Any, q: Vector, spin: Vector) -> Vector:
    """The torque of the case with a compiled function; ``test_scene_bodies`` compiles the same."""
    return [0.25 - 0.125 * spin[0], 0.5 * t * q[3], 0.5 * q[0] - 0.0625 * t * spin[2]]


class World:
    """A case in the numbers of `number`; `root` is their square root."""

    def __init__(self, case: dict[str, Any], number: Callable[[float], Any] = float, root: Any = np.sqrt) -> None:
        def exact(values: Any) -> Any:
            return [exact(value) for value in values] if isinstance(values, list | tuple) else number(values)

        self.root = root
        particles = case.get("particles") or {"mass": [], "position": []}
        self.n, bodies = len(particles["mass"]), case["bodies"]
        self.k = len(bodies["mass"])
        none = [ORIGIN] * self.k
        self.mass = exact(particles["mass"]) + exact(bodies["mass"])
        self.position = exact(particles["position"]) + exact(bodies.get("position", none))
        velocities = exact(particles.get("velocity", [ORIGIN] * self.n))
        self.velocity = velocities + exact(bodies.get("velocity", none))
        self.turn = exact(bodies.get("orientation", [[0.0, 0.0, 0.0, 1.0]] * self.k))
        self.spin = exact(bodies.get("angular_velocity", none))
        if "inertia" in bodies:
            self.inertia = exact(bodies["inertia"])
        else:
            rows = ([[a, 0.0, 0.0], [0.0, b, 0.0], [0.0, 0.0, c]] for a, b, c in bodies["moments"])
            self.inertia = exact(list(rows))
        # The center from the fixed point, along the body's axes.
        fixed = bodies.get("pivot") or [None] * self.k
        self.center = [None if point is None else times(number(-1), exact(point)) for point in fixed]
        self.about = [self._about(body) for body in range(self.k)]
        self.inverse = [inverse(tensor) for tensor in self.about]
        self.forces = [
            (name, {key: self._given(key, value, exact) for key, value in of.items()}) for name, of in case["forces"]
        ]
        self.fixed_point = [
            None if arm is None else minus(self.position[self.n + body], apply(rotation(self.turn[body]), arm))
            for body, arm in enumerate(self.center)
        ]

    @staticmethod
    def _given(key: str, value: Any, exact: Callable[[Any], Any]) -> Any:
        return value if key in ("body", "to", "particle", "frame", "function") or value is None else exact(value)

    def _about(self, body: int) -> list[Vector]:
        """The tensor about the fixed point, or the center of mass."""
        arm = self.center[body]
        if arm is None:
            return self.inertia[body]
        mass, square = self.mass[self.n + body], dot(arm, arm)
        tensor = self.inertia[body]
        return [
            [tensor[i][j] + mass * ((square if i == j else 0) - arm[i] * arm[j]) for j in range(3)] for i in range(3)
        ]

    # The state: places and velocities of all that moves freely, then quaternions and spins.

    def start(self) -> Vector:
        free = [i for i in range(self.n + self.k) if i < self.n or self.center[i - self.n] is None]
        self.free = free
        places = [part for i in free for part in self.position[i]]
        speeds = [part for i in free for part in self.velocity[i]]
        return places + speeds + [part for q in self.turn for part in q] + [part for w in self.spin for part in w]

    def parts(self, y: Vector) -> tuple[list[Vector], list[Vector], list[Vector], list[Vector]]:
        """Places and velocities of all centers, quaternions and spins."""
        count = 3 * len(self.free)
        turn = [y[2 * count + 4 * k : 2 * count + 4 * k + 4] for k in range(self.k)]
        at = 2 * count + 4 * self.k
        spin = [y[at + 3 * k : at + 3 * k + 3] for k in range(self.k)]
        x: list[Vector] = [[]] * (self.n + self.k)
        v: list[Vector] = [[]] * (self.n + self.k)
        for place, i in enumerate(self.free):
            x[i] = list(y[3 * place : 3 * place + 3])
            v[i] = list(y[count + 3 * place : count + 3 * place + 3])
        for k, arm in enumerate(self.center):
            if arm is not None:
                matrix = rotation(turn[k])
                x[self.n + k] = add(self.fixed_point[k], apply(matrix, arm))
                v[self.n + k] = apply(matrix, cross(spin[k], arm))
        return x, v, turn, spin

    def rates(self, t: Any, y: Vector) -> Vector:
        x, v, turn, spin = self.parts(y)
        matrices = [rotation(q) for q in turn]
        acceleration, torque = self.loads(t, x, v, turn, spin, matrices)
        turn_rates, spin_rates = [], []
        for k in range(self.k):
            arm, back = self.center[k], transposed(matrices[k])
            own = apply(back, torque[k])
            if arm is not None:
                own = add(own, cross(arm, apply(back, times(self.mass[self.n + k], acceleration[self.n + k]))))
            momentum = apply(self.about[k], spin[k])
            spin_rates += apply(self.inverse[k], minus(own, cross(spin[k], momentum)))
            (qx, qy, qz, qw), (a, b, c) = turn[k], spin[k]
            turn_rates += [
                (qw * a + qy * c - qz * b) / 2,
                (qw * b + qz * a - qx * c) / 2,
                (qw * c + qx * b - qy * a) / 2,
                -(qx * a + qy * b + qz * c) / 2,
            ]
        places = [part for i in self.free for part in v[i]]
        return places + [part for i in self.free for part in acceleration[i]] + turn_rates + spin_rates

    def loads(self, t: Any, x: Any, v: Any, turn: Any, spin: Any, matrices: Any) -> tuple[list[Vector], list[Vector]]:
        """Accelerations of all centers that forces alone would give, and torques in space about them."""
        zero = 0 * self.mass[0] if self.mass else 0.0
        acceleration = [[zero] * 3 for _ in x]
        torque = [[zero] * 3 for _ in range(self.k)]

        def push(i: int, force: Vector) -> None:
            acceleration[i] = add(acceleration[i], times(1 / self.mass[i], force))

        def twist(k: int, of: Vector) -> None:
            torque[k] = add(torque[k], of)

        for name, of in self.forces:
            body = of.get("body")
            chosen = range(self.k) if body is None else [body]
            if name == "UniformField":
                acceleration = [add(a, of["g"]) for a in acceleration]
            elif name == "Gravity":
                self._gravity(of["G"], x, matrices, acceleration, torque)
            elif name == "AppliedTorque":
                for k in chosen:
                    twist(k, apply(matrices[k], of["torque"]) if of.get("frame") == "body" else of["torque"])
            elif name == "RotationalDrag":
                for k in chosen:
                    twist(k, times(-of["coefficient"], apply(matrices[k], spin[k])))
            elif name == "CompiledTorque":
                for k in chosen:
                    twist(k, motor(t, turn[k], spin[k]))
            elif name == "AttachedSpring":
                d, rate, ends = self._spring(of, x, v, spin, matrices)
                force = times(-of["stiffness"], d)
                length, damping = of.get("length", 0), of.get("damping", 0)
                if length or damping:
                    size = self.root(dot(d, d))
                    pull = of["stiffness"] * (size - length) + damping * dot(d, rate) / size
                    force = times(-pull / size, d)
                for sign, end in zip((1, -1), ends, strict=True):
                    if end is not None:
                        push(end[0], times(sign, force))
                        if end[0] >= self.n:
                            twist(end[0] - self.n, cross(end[1], times(sign, force)))
            else:
                raise ValueError(name)
        return acceleration, torque

    def _spring(self, of: dict[str, Any], x: Any, v: Any, spin: Any, matrices: Any) -> tuple[Any, Any, Any]:
        """From the other end to the point, the rate of that, and both ends: which mass, and the arm in space."""

        def end(k: int, point: Vector) -> tuple[Vector, Vector, tuple[int, Vector]]:
            arm, i = apply(matrices[k], point), self.n + k
            return add(x[i], arm), add(v[i], apply(matrices[k], cross(spin[k], point))), (i, arm)

        place, speed, own = end(of["body"], of["point"])
        if of.get("to") is not None:
            there, drift, other = end(of["to"], of.get("to_point", ORIGIN))
        elif of.get("particle") is not None:
            i = of["particle"]
            there, drift, other = x[i], v[i], (i, ORIGIN)
        else:
            there, drift, other = of["anchor"], ORIGIN, None
        return minus(place, there), minus(speed, drift), (own, other)

    def _gravity(self, constant: Any, x: Any, matrices: Any, acceleration: Any, torque: Any) -> None:
        """Newton's law between centers, and MacCullagh's term of each body for the mass of each other."""
        for i in range(len(x)):
            for j in range(len(x)):
                if i == j:
                    continue
                d = minus(x[j], x[i])
                square = dot(d, d)
                cube = square * self.root(square)
                acceleration[i] = add(acceleration[i], times(constant * self.mass[j] / cube, d))
                if i < self.n:
                    continue
                # The body i: φ = G (tr I)/(2 r³) − 3 G d·I d/(2 r⁵), whose gradient pulls at j and back at i.
                k = i - self.n
                tensor = product(product(matrices[k], self.inertia[k]), transposed(matrices[k]))
                along = apply(tensor, d)
                trace = tensor[0][0] + tensor[1][1] + tensor[2][2]
                fifth = cube * square
                outward = (-3 * trace / 2 + 15 * dot(d, along) / (2 * square)) / fifth
                gradient = times(constant, minus(times(outward, d), times(3 / fifth, along)))
                acceleration[j] = add(acceleration[j], gradient)
                acceleration[i] = minus(acceleration[i], times(self.mass[j] / self.mass[i], gradient))
                torque[k] = add(torque[k], times(3 * constant * self.mass[j] / fifth, cross(d, along)))

    # What is conserved.

    def energy(self, y: Vector) -> Any:
        """Of motion, and of the fields, gravity and springs."""
        x, v, turn, spin = self.parts(y)
        matrices = [rotation(q) for q in turn]
        total = sum(m * dot(w, w) / 2 for m, w in zip(self.mass, v, strict=True))
        total += sum(dot(w, apply(tensor, w)) / 2 for w, tensor in zip(spin, self.inertia, strict=True))
        for name, of in self.forces:
            if name == "UniformField":
                total -= sum(m * dot(of["g"], place) for m, place in zip(self.mass, x, strict=True))
            elif name == "AttachedSpring":
                d = self._spring(of, x, v, spin, matrices)[0]
                total += of["stiffness"] * (self.root(dot(d, d)) - of.get("length", 0)) ** 2 / 2
            elif name == "Gravity":
                for i in range(len(x)):
                    for j in (j for j in range(len(x)) if j != i):
                        d = minus(x[j], x[i])
                        square = dot(d, d)
                        size = self.root(square)
                        total -= of["G"] * self.mass[i] * self.mass[j] / size / 2
                        if i >= self.n:
                            tensor, n = self.inertia[i - self.n], apply(transposed(matrices[i - self.n]), d)
                            trace = tensor[0][0] + tensor[1][1] + tensor[2][2]
                            shape = trace - 3 * dot(n, apply(tensor, n)) / square
                            total -= of["G"] * self.mass[j] * shape / (2 * square * size)
        return total

    def momentum(self, y: Vector) -> Vector:
        _, v, _, _ = self.parts(y)
        return [sum(m * w[c] for m, w in zip(self.mass, v, strict=True)) for c in range(3)]

    def angular_momentum(self, y: Vector) -> Vector:
        """About the origin, in space."""
        x, v, turn, spin = self.parts(y)
        total = ORIGIN
        for m, place, speed in zip(self.mass, x, v, strict=True):
            total = add(total, times(m, cross(place, speed)))
        for k in range(self.k):
            total = add(total, apply(rotation(turn[k]), apply(self.inertia[k], spin[k])))
        return total


def by_dop853(case: dict[str, Any], rtol: float = 1e-13) -> tuple[World, list[Vector]]:
    """The states at the times of a case, by SciPy."""
    world = World(case)
    found = solve_ivp(
        lambda t, y: np.array(world.rates(t, list(y)), float),
        (0.0, case["times"][-1]),
        np.array(world.start(), float),
        "DOP853",
        t_eval=case["times"],
        rtol=rtol,
        atol=1e-14,
    )
    return world, [list(map(float, y)) for y in found.y.T]


def by_extrapolation(
    case: dict[str, Any], digits: int = 40, tolerance: float = 1e-24, columns: int = 12
) -> tuple[World, list[Vector]]:
    """The states at the times of a case, by extrapolated midpoint steps in so many digits; call it within `workdps`."""
    mpmath.mp.dps = digits
    world = World(case, mpmath.mpf, mpmath.sqrt)
    t, y, h = mpmath.mpf(0), world.start(), mpmath.mpf(1) / 16
    states = []
    for time in map(mpmath.mpf, case["times"]):
        while t < time:
            step = min(h, time - t)
            trial, error = extrapolated(world.rates, t, y, step, columns)
            if error <= tolerance:
                t, y = (time if step == time - t else t + step), trial
            wanted = mpmath.mpf(tolerance) / max(error, mpmath.mpf(10) ** (5 - digits))
            factor = min(2, max(0.25, float(wanted) ** (1 / (2 * columns - 1)) * 0.9))
            # The rest up to an output time says nothing against the step before.
            h = step * factor if step == h or factor < 1 else h
        states.append(y)
    return world, states


def extrapolated(rates: Callable[[Any, Vector], Vector], t: Any, y: Vector, h: Any, columns: int) -> tuple[Vector, Any]:
    """A step by Neville's scheme in h², and how far its last two columns are apart."""
    table: list[Vector] = []
    first = rates(t, y)
    for row in range(columns):
        count = 2 * (row + 1)
        small = h / count
        before, now = y, add(y, times(small, first))
        for step in range(1, count):
            before, now = now, add(before, times(2 * small, rates(t + step * small, now)))
        last = rates(t + h, now)
        new = [times(0.5, add(add(now, before), times(small, last)))]
        for column in range(row):
            ratio = (mpmath.mpf(count) / (2 * (row - column))) ** 2 - 1
            new.append(add(new[column], times(1 / ratio, minus(new[column], table[column]))))
        table = new
    return table[-1], max(abs(a - b) for a, b in zip(table[-1], table[-2], strict=True))


def by_columns(world: World, states: Sequence[Vector]) -> dict[str, list[Any]]:
    """Places, velocities, quaternions of length 1 and spins, as lists of the nearest floats."""
    columns: dict[str, list[Any]] = {"position": [], "velocity": [], "orientation": [], "angular_velocity": []}
    for y in states:
        x, v, turn, spin = world.parts(y)
        turn = [times(1 / world.root(sum(part * part for part in q)), q) for q in turn]
        for column, rows in zip(columns.values(), (x, v, turn, spin), strict=True):
            column.append([[float(part) for part in row] for row in rows])
    return columns
