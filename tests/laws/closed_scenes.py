"""Random closed scenes, and what the error of a method on them may be.

Scenes are softened, so that every method resolves them with the same step and a law is not drowned by a close
encounter.

No bound is tuned to a method. What a method declares (its order, whether it is symplectic, reversible, adaptive) says
what it must keep to round-off; of all else, the error of its state is measured, and what follows from that is allowed.
Bounds of round-off are about four times the worst of 500 examples, which is noted beside them.
"""

from functools import cache

import numpy as np
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from numpy.typing import NDArray

import visviva as vv

METHODS = vv.methods()
NAMES = [method.name for method in METHODS]
STEP = 1 / 64
END = 1.0


def arrays(shape: tuple[int, ...], low: float, high: float) -> st.SearchStrategy[NDArray[np.float64]]:
    return hnp.arrays(np.float64, shape, elements=st.floats(low, high, width=32))


@st.composite
def closed_scenes(draw: st.DrawFn) -> vv.Scene:
    """Two to five softened bodies; the first has mass, the others may have none."""
    count = draw(st.integers(2, 5))
    masses = np.concatenate([[1.0], draw(arrays((count - 1,), 0.0, 2.0))])
    masses[masses < 1e-3] = 0.0
    bodies = vv.Particles(masses, draw(arrays((count, 3), -2.0, 2.0)), draw(arrays((count, 3), -1.0, 1.0)))
    softening = draw(st.floats(0.5, 1.0))
    return vv.Scene(
        bodies, vv.Gravity(draw(st.floats(0.25, 1.0)), softening=softening), t0=draw(st.floats(-4.0, 4.0, width=32))
    )


@cache
def step(method: vv.Method) -> float:
    """The step with which a method resolves these scenes: half of the largest at which its error falls as it should.

    Found on the most violent of them: bodies of the largest masses, close together, at the least softening.
    """
    position = [[-0.5, 0.0, 0.0], [0.5, 0.1, 0.0], [0.0, 0.6, 0.3], [0.1, -0.5, -0.4], [0.0, 0.0, 0.7]]
    velocity = [[0.0, 1.0, -1.0], [1.0, 0.0, 0.5], [-1.0, 0.5, 0.0], [0.5, -1.0, 1.0], [0.0, 0.0, -1.0]]
    scene = vv.Scene(vv.Particles([1.0, 2.0, 2.0, 2.0, 2.0], position, velocity), vv.Gravity(1.0, softening=0.5))

    def end(dt: float) -> NDArray[np.float64]:
        return scene.run(t=END, method=method.name, dt=dt).position[-1]

    # At order 1 an error that falls is not yet a small one, and a run says that a tenth of the energy is not resolved.
    length = 2 * STEP if method.order > 1 else STEP / 32
    while length > END / 4096:
        ends = [end(length / 2**halvings) for halvings in range(3)]
        change, next_change = distance(ends[0], ends[1]), distance(ends[1], ends[2])
        # Orders above 6 may reach round-off within these three.
        if change < 0.5 and next_change < 2.0 * change / 2.0 ** min(method.order, 6) + 1e-13:
            return length / 2
        length /= 2
    raise AssertionError(f"{method.name} of order {method.order} converges at no step")


def tolerance(method: vv.Method) -> float:
    """Some hundred steps of an adaptive method of any order."""
    return max(1e-12, 10.0 ** (-2.0 * method.order))


def arguments(method: vv.Method, scale: float = 1.0) -> dict[str, object]:
    """A step for a fixed-step method, a tolerance for an adaptive one."""
    tight: dict[str, object] = {"rtol": tolerance(method)} if method.adaptive else {"dt": step(method) * scale}
    return {"method": method.name} | tight


def run(scene: vv.Scene, method: vv.Method, end: float = END, **more: object) -> vv.Trajectory:
    return scene.run(t=scene.t0 + np.linspace(0.0, end, 5), **(arguments(method) | more))  # type: ignore[arg-type]


# Positions and velocities are a few units: a few roundings of some tens of steps, and what the forces make of them.


ROUND_OFF = 2e-14


def state_error(scene: vv.Scene, method: vv.Method) -> float:
    """How far positions and velocities of `run` may be from the truth.

    Adaptive: its tolerance, once for each of some fifty steps (worst: 12). Fixed steps: a method of order p halves its
    step and moves by all but 2⁻ᵖ of the error, so the error is at most twice that; half as much again is allowed for
    terms that are not asymptotic yet.
    """
    if method.adaptive:
        return 50.0 * tolerance(method)
    whole, half = run(scene, method), run(scene, method, dt=step(method) / 2)
    return 3.0 * max(distance(whole.position, half.position), distance(whole.velocity, half.velocity)) + ROUND_OFF


def energy_error(scene: vv.Scene, error: float) -> float:
    """What an error of the state makes of the energy: Σ m (|v| δv + |a| δx), to first order, twice.

    No softened acceleration exceeds G M 2/(√27 ε²), and no speed the first one by more than that times the span.
    """
    bodies, (gravity,) = scene.particles, scene.forces
    assert isinstance(gravity, vv.Gravity)
    total = float(bodies.mass.sum())
    acceleration = gravity.G * total * 2.0 / np.sqrt(27.0) / gravity.softening**2
    speed = float(np.linalg.norm(bodies.velocity, axis=1).max()) + acceleration * END
    return 2.0 * total * (speed + acceleration) * error


def energy_changes(out: vv.Trajectory) -> NDArray[np.float64]:
    """What the energy has gained at each time."""
    return out.energy - out.energy[0]


def distance(a: NDArray[np.float64], b: NDArray[np.float64]) -> float:
    return float(np.abs(a - b).max())
