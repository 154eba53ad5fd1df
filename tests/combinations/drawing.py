"""How a parameter of each kind is drawn, and which forces, potentials and methods there are.

Everything is asked of the package, so that a force or potential joins by being registered. A parameter of a kind that
is not known here fails by name: it must be drawn by some test before it can be trusted.

A force is drawn from (name, seed, bodies): small, printable, the same everywhere. An event is drawn from (name, seed)
and the scene that it is looked for in, where some of them should be found.
"""

from __future__ import annotations

import inspect
import random
from functools import partial
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

import visviva as vv
from visviva import _core

if TYPE_CHECKING:
    from collections.abc import Callable


def force_classes() -> dict[str, type[Any]]:
    """Every public force, by the name of its class."""
    public = [getattr(vv, name) for name in vv.__all__]
    found = [cls for cls in public if isinstance(cls, type) and issubclass(cls, vv.forces.Force)]
    found = [cls for cls in found if not inspect.isabstract(cls) and cls is not vv.forces.Force]
    return {cls.__name__: cls for cls in sorted(found, key=lambda cls: cls.__name__)}


FORCES = force_classes()
POTENTIALS = {entry["class_name"]: entry for entry in _core.potentials()}
# What is kept (`kept.py`) from when there were no others stays what it was.
FIRST_POTENTIALS = ["Coulomb", "Yukawa", "LennardJones"]
METHODS = {method.name: method for method in vv.methods()}
RIGID_METHODS = {method.name: method for method in vv.rigid.methods()}
# Potentials a derivative of which jumps somewhere, the third or a higher one.
ROUGH = {"SoftSphere", "Tabulated", "PiecewisePolynomial"}
# As those, in a speed.
ROUGH_FORCES = {"Drag", "SampledDrag"}
# A function of one's own is no value that a recipe could hold, and scenes have no generalized coordinates.
EVENTS = sorted(set(vv.events.__all__) - {"Event", "EventTable", "function", "coordinate"})
# As with potentials: what is kept looks for those of before.
FIRST_EVENTS = [name for name in EVENTS if name != "expression"]


def declared(cls: type[Any]) -> list[dict[str, Any]]:
    """Name, kind, sign, choices and default of each parameter: as the registry has them, else from the signature."""
    registered = {entry["class_name"]: entry for entry in _core.forces()} if hasattr(_core, "forces") else {}
    if cls.__name__ in registered:
        return [_complete(parameter) for parameter in registered[cls.__name__]["parameters"]]
    signature = inspect.signature(cls.__init__).parameters
    return [
        _complete({"name": name, "default": None if found.default is found.empty else found.default})
        | _kind(name, str(found.annotation))
        for name, found in signature.items()
        if name != "self"
    ]


def _complete(parameter: dict[str, Any]) -> dict[str, Any]:
    """What is not said of a parameter is what a potential of one number has."""
    sign = "positive" if parameter.get("positive") else "any"
    return {"kind": "number", "sign": sign, "choices": (), "default": None} | parameter


def _kind(name: str, annotation: str) -> dict[str, str]:
    if "Potential" in annotation:
        return {"kind": "potential"}
    if "ArrayLike" in annotation:
        return {"kind": "point" if name == "center" else "vector"}
    if annotation == "float":
        return {"kind": "number", "sign": "not_negative" if name == "softening" else "any"}
    return {"kind": annotation}


class Draw:
    """Values of each kind. Tame ones keep a scene of spacing 2 well-behaved; others may be anything that is allowed."""

    def __init__(self, words: object, bodies: int, *, tame: bool) -> None:
        self.random = random.Random(repr(words))
        self.bodies, self.tame = bodies, tame
        self.potentials = list(POTENTIALS)
        self.pairs: list[int] = []

    def number(self, sign: str = "any") -> float:
        size = self.random.uniform(0.25, 1.0)
        if not self.tame and self.random.random() < 0.3:
            size = self.random.choice([0.0, 1e-3, 3.0, 40.0])
        if sign == "positive":
            return size or 1.0
        if sign == "not_negative":
            return self.random.choice([0.0, size, size])
        return size * self.random.choice([1.0, 1.0, -1.0])

    def vector(self) -> tuple[float, float, float]:
        x, y, z = (self.random.choice([0.0, self.number(), self.number()]) for _ in range(3))
        return x, y, z

    def direction(self) -> tuple[float, float, float]:
        x, y, z = self.vector()
        return (x, y, z) if x or y or z else (0.0, 0.0, 1.0)

    def point(self) -> tuple[float, float, float]:
        """A fixed point: of a tame scene far outside the bodies, else anywhere."""
        if self.tame:
            x, y, z = (self.random.choice([-12.0, 12.0]) + self.number() for _ in range(3))
            return x, y, z
        return self.vector()

    def potential(self) -> vv.potentials.Potential:
        entry = POTENTIALS[self.random.choice(self.potentials)]
        if entry["class_name"] in self.TABLES:
            return self.TABLES[entry["class_name"]](self)
        values = {parameter["name"]: self.value(_complete(parameter)) for parameter in entry["parameters"]}
        # Exponents that go together, whole and broken.
        if "n" in values:
            values["n"] = self.random.choice([2.0, 3.0, 2.5, 4.0, 2.0 + values["n"]])
        if "m" in values:
            values["n"] += 1.0 + values["m"]
        made: vv.potentials.Potential = getattr(vv.potentials, entry["class_name"])(**values)
        return made

    def tabulated(self) -> vv.potentials.Potential:
        """A table that most scenes stay in, with more points where it is steep; wild ones end before a scene does."""
        r = np.geomspace(2.0**-6, 64.0 if self.tame else 8.0, 80)
        return vv.potentials.Tabulated(r, self.number() / r + self.number() * np.exp(-r * self.number("positive")))

    def custom(self) -> vv.potentials.Potential:
        """What `Custom` makes of a function, over distances as of a table."""
        strength, decay, rate = self.number(), self.number(), self.number("positive")
        last = 64.0 if self.tame else 8.0
        return vv.potentials.Custom(lambda r: strength / r + decay * np.exp(-rate * r), 2.0**-6, last, tolerance=1e-9)

    def formula(self) -> vv.potentials.Potential:
        """What `Custom` makes of a formula."""
        numbers = {"strength": self.number(), "decay": self.number(), "rate": self.number("positive")}

        def of_distance(r: Any, strength: Any, decay: Any, rate: Any) -> Any:
            return strength / r + decay * np.exp(-rate * r)

        return vv.potentials.Custom(of_distance, parameters=numbers)

    def sampled_drag(self) -> vv.SampledDrag:
        """What `drag.custom` makes of a law, known up to speeds that a tame scene does not reach."""
        slow, fast = self.number("positive"), self.number("not_negative")
        last = 256.0 if self.tame else 8.0
        numbers = {name: self.number("positive") for name in ("density", "viscosity")}
        radius = [self.number("not_negative") for _ in range(self.bodies)]
        return vv.drag.custom(
            lambda R: 6 * np.pi * slow / R + fast, 2.0**-6, last, **numbers, radius=radius, tolerance=1e-9
        )

    def expression(self) -> vv.forces.Force:
        """A force of one's own: a wave in a bowl, at rest or running, or what turns, slows down and shakes bodies."""
        wave = tuple(self.number() for _ in range(3))
        numbers = {name: self.number() for name in ("strength", "rate")} | {"bowl": self.number("positive")}

        def potential(r: Any, _: Any, t: Any, **of: Any) -> Any:
            phase = wave[0] * r[0] + wave[1] * r[1] + wave[2] * r[2] - (of["rate"] * t if running else 0.0)
            return of["strength"] * np.cos(phase) + of["bowl"] * (r[0] ** 2 + r[1] ** 2 + r[2] ** 2)

        def components(r: Any, v: Any, t: Any, **of: Any) -> Any:
            shaken = of["strength"] * np.sin(of["rate"] * t)
            return of["rate"] * v[1] - of["bowl"] * v[0], -of["rate"] * v[0] + shaken, np.tanh(r[2]) * shaken

        running = self.random.random() < 0.3
        given = {"force": components} if self.random.random() < 0.3 else {"potential": potential}
        made = vv.ExpressionForce(**given, parameters=numbers)
        return made if self.tame else made.shifted(np.array(self.vector()), np.zeros(3))

    # What has a table is drawn as a whole: its columns go together.
    TABLES: ClassVar[dict[str, Callable[[Draw], vv.potentials.Potential]]] = {
        "Tabulated": tabulated,
        "PiecewisePolynomial": custom,
        "Expressed": formula,
    }

    def indices(self) -> list[int]:
        """Bodies of the listed pairs: the first of each, and when asked again the second, which is another."""
        if not self.pairs:
            self.pairs = [self.random.randrange(self.bodies) for _ in range(self.random.randint(1, 3))]
            return self.pairs
        others = max(self.bodies - 1, 1)
        return [(first + 1 + self.random.randrange(others)) % self.bodies for first in self.pairs]

    def value(self, parameter: dict[str, Any]) -> Any:
        """A value for a parameter as it is declared."""
        sign, count = parameter["sign"], len(self.pairs) or self.bodies
        drawn = {
            "number": lambda: self.number(sign),
            "numbers": lambda: [self.number(sign) for _ in range(count)],
            "vector": self.vector,
            "axial_vector": self.vector,
            "direction": self.direction,
            "point": self.point,
            "potential": self.potential,
            "indices": self.indices,
            "choice": lambda: self.random.choice(list(parameter["choices"])),
        }
        if parameter["kind"] not in drawn:
            name, kind = parameter["name"], parameter["kind"]
            raise NotImplementedError(f"tests/combinations/drawing.py cannot draw {name!r} of kind {kind!r} yet")
        return drawn[parameter["kind"]]()


def force(name: str, seed: int, bodies: int, *, tame: bool) -> Any:
    """The force of that name and seed; of ``name/3`` with one of the first three potentials that there were."""
    name, _, potentials = name.partition("/")
    draw = Draw((name, seed), bodies, tame=tame)
    draw.potentials = FIRST_POTENTIALS if potentials else list(POTENTIALS)
    if name == "SampledDrag":
        return draw.sampled_drag()
    if name == "ExpressedForce":
        return draw.expression()
    arguments = {}
    for parameter in declared(FORCES[name]):
        value = draw.value(parameter)
        # Half of the optional ones keep their default, which may be a singular case; a tame scene gives all.
        if tame or parameter["default"] is None or draw.random.random() < 0.5:
            arguments[parameter["name"]] = value
    if name == "Drag" and not any(arguments["radius"]):
        # Spheres without a size feel nothing, and promise everything.
        arguments["radius"][0] = 0.5
    return FORCES[name](**arguments)


def event(name: str, seed: int, scene: vv.Scene, span: float) -> vv.events.Event:
    """The event of that name and seed: of bodies of the scene, at a value that they may well pass in the span."""
    draw = random.Random(repr((name, seed)))
    bodies = scene.particles
    first = draw.randrange(max(len(bodies), 1))
    # Without a second body it is one that the scene has not: refused by name.
    second = (first + 1 + draw.randrange(max(len(bodies) - 1, 1))) % max(len(bodies), 2)
    share = draw.random()
    how: dict[str, Any] = {"direction": draw.choice([-1, 0, 0, 1])}
    if name == "distance":
        pair = [index % max(len(bodies), 1) for index in (first, second)]
        apart, closing = (np.subtract(*array[pair]) for array in (bodies.position, bodies.velocity))
        length = float(np.linalg.norm(apart + share * span * closing))
        return vv.events.distance(first, second, below=length or 1.0, **how)
    if name == "plane":
        through = bodies.position[first] + share * span * bodies.velocity[first]
        normal = [draw.choice([0.0, 1.0, draw.uniform(-1.0, 1.0)]) for _ in range(3)]
        return vv.events.plane(through, normal if any(normal) else [1.0, 0.0, 0.0], body=first, **how)
    if name == "apsis":
        focus = second if draw.random() < 0.5 else bodies.position[first] + share * span
        return vv.events.apsis(first, focus, **how)
    if name == "energy":
        try:
            return vv.events.energy(scene.invariants().energy * (1.0 + 1e-3 * (share - 0.5)), **how)
        except vv.InvalidInput:
            return vv.events.energy(share, **how)
    if name == "expression":
        pair = [index % max(len(bodies), 1) for index in (first, second)]
        return vv.events.expression(expression(draw.randrange(5), pair, bodies, share * span), **how)
    raise NotImplementedError(f"tests/combinations/drawing.py cannot draw the event {name!r} yet")


def expression(kind: int, pair: list[int], bodies: vv.Particles, later: float) -> Callable[..., Any]:
    """What a straight motion passes at a time, by two bodies or one: linear, a root, a square, of speeds, or a wave."""
    place, velocity = bodies.position + later * bodies.velocity, bodies.velocity
    # Of a module, so that other processes may have it.
    return partial(_passed, (kind, *pair, float(_passed((kind, *pair, 0.0), later, place, velocity))))


def _passed(of: tuple[int, int, int, float], t: Any, position: Any, velocity: Any) -> Any:
    kind, i, j, level = of
    x, v = position, velocity
    functions: list[Callable[[], Any]] = [
        lambda: x[i, 0] - x[j, 0],
        lambda: np.sqrt((x[i] - x[j]) @ (x[i] - x[j]) + 0.25),
        lambda: x[i] @ x[i] - 0.5 * x[j, 1] ** 2,
        lambda: (x[i] - x[j]) @ (v[i] - 0.5 * v[j]),
        lambda: np.sin(x[i, 0] + x[j, 2]) + np.exp(-(x[i, 1] ** 2)),
    ]
    return functions[kind]() - level


def _needs_mass(name: str) -> bool:
    """Whether bodies without mass are refused by every force of that name."""
    bodies = vv.Particles(np.zeros(3), 2.0 * np.eye(3))
    for seed in range(6):
        try:
            vv.Scene(bodies, force(name, seed, 3, tame=True)).acceleration()
        except vv.InvalidInput:
            continue
        return False
    return True


NEED_MASS = frozenset(name for name in FORCES if _needs_mass(name))
