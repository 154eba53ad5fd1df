"""How a parameter of each kind is drawn, and which forces, potentials and methods there are.

Everything is asked of the package, so that a force or potential joins by being registered. A parameter of a kind that
is not known here fails by name: it must be drawn by some test before it can be trusted.

A force is drawn from (name, seed, bodies): small, printable, the same everywhere.
"""

from __future__ import annotations

import inspect
import random
from typing import Any

import visviva as vv
from visviva import _core

Number = float | tuple[float, float, float]


def force_classes() -> dict[str, type[Any]]:
    """Every public force, by the name of its class."""
    public = [getattr(vv, name) for name in vv.__all__]
    found = [cls for cls in public if isinstance(cls, type) and issubclass(cls, vv.forces.Force)]
    found = [cls for cls in found if not inspect.isabstract(cls) and cls is not vv.forces.Force]
    return {cls.__name__: cls for cls in sorted(found, key=lambda cls: cls.__name__)}


def potential_names() -> list[str]:
    return [entry["name"] for entry in _core.potentials()]


FORCES = force_classes()
POTENTIALS = potential_names()
METHODS = {method.name: method for method in vv.methods()}


def declared(cls: type[Any]) -> list[tuple[str, str, bool]]:
    """(name, kind, optional) of each parameter: as the core's registry declares it, else from the signature."""
    registered = {entry["class_name"]: entry for entry in _core.forces()} if hasattr(_core, "forces") else {}
    signature = inspect.signature(cls.__init__).parameters
    names = [name for name in signature if name != "self"]
    optional = {name: signature[name].default is not inspect.Parameter.empty for name in names}
    if cls.__name__ in registered:
        entry = registered[cls.__name__]
        return [(p["name"], str(p["kind"]), optional.get(p["name"], False)) for p in entry["parameters"]]
    return [(name, _kind(name, str(signature[name].annotation)), optional[name]) for name in names]


def _kind(name: str, annotation: str) -> str:
    if "Potential" in annotation:
        return "potential"
    if "ArrayLike" in annotation:
        return "vector"
    if annotation == "float":
        return "not negative" if name in ("softening", "length", "tau") else "number"
    if annotation == "int":
        return "index"
    return annotation


class Draw:
    """Values of each kind. Tame ones keep a scene of spacing 2 well-behaved; others may be anything that is allowed."""

    def __init__(self, words: object, bodies: int, *, tame: bool) -> None:
        self.random = random.Random(repr(words))
        self.bodies, self.tame = bodies, tame

    def number(self) -> float:
        size = self.random.uniform(0.25, 1.0)
        if not self.tame and self.random.random() < 0.3:
            size = self.random.choice([0.0, 1e-3, 3.0, 40.0])
        return size * self.random.choice([1.0, 1.0, -1.0])

    def positive(self) -> float:
        size = self.random.uniform(0.5, 1.0)
        return size if self.tame or self.random.random() < 0.7 else self.random.choice([1e-2, 5.0])

    def not_negative(self) -> float:
        return self.random.choice([0.0, self.positive(), self.positive()])

    def vector(self) -> tuple[float, float, float]:
        x, y, z = (self.random.choice([0.0, self.number(), self.number()]) for _ in range(3))
        return x, y, z

    def place(self) -> tuple[float, float, float]:
        """A fixed point: of a tame scene far outside the bodies, else anywhere."""
        if self.tame:
            x, y, z = (self.random.choice([-12.0, 12.0]) + self.number() for _ in range(3))
            return x, y, z
        return self.vector()

    def potential(self) -> vv.potentials.Potential:
        entry = self.random.choice(_core.potentials())
        values = [self.positive() if p["positive"] else self.number() for p in entry["parameters"]]
        return vv.potentials.potential_by_name(entry["name"], values)

    def index(self) -> int:
        return self.random.randrange(self.bodies)

    def of_kind(self, name: str, kind: str) -> Any:
        """A value for the parameter `name` of a declared kind."""
        words = kind.lower().replace("_", " ").replace("-", " ")
        if words == "vector":
            return self.place() if name in ("center", "origin", "point") else self.vector()
        drawn = {
            "number": self.number,
            "positive": self.positive,
            "not negative": self.not_negative,
            "nonnegative": self.not_negative,
            "potential": self.potential,
            "index": self.index,
            "indices": lambda: [self.index() for _ in range(2)],
            "per particle": lambda: [self.number() for _ in range(self.bodies)],
            "per particle array": lambda: [self.number() for _ in range(self.bodies)],
        }
        if words not in drawn:
            raise NotImplementedError(f"tests/combinations/drawing.py cannot draw {name!r} of kind {kind!r} yet")
        return drawn[words]()


def force(name: str, seed: int, bodies: int, *, tame: bool) -> Any:
    """The force of that name and seed."""
    cls = FORCES[name]
    draw = Draw((name, seed), bodies, tame=tame)
    arguments = {}
    for parameter, kind, optional in declared(cls):
        value = draw.of_kind(parameter, kind)
        # Half of the optional ones keep their default, which may be a singular case; a tame scene gives all.
        if tame or not optional or draw.random.random() < 0.5:
            arguments[parameter] = value
    return cls(**arguments)
