"""Velocities given for bodies with fixed points, alone and in copies: what follows from the spin, and how nearly.

A billionth beside it is taken for it; what a run gives, which is it but for roundings, stays to the bit.
"""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest

import visviva as vv

EPSILON = float(np.finfo(np.float64).eps)
#: Spins of 2 about z, 3 from the fixed point: 6 along y, of a free body 7 along x.
HELD: dict[str, Any] = {"angular_velocity": [0.0, 0.0, 2.0], "pivot": [-3.0, 0.0, 0.0]}
SPEED = 6.0
#: By which part it is off, and whether that stays: up to 16 roundings does, of ω · arm, which is the speed here.
OFF = [(0.0, True), (4 * EPSILON, True), (15 * EPSILON, True), (18 * EPSILON, False), (0.9e-9, False)]
TOO_FAR = 1.1e-9


def scene() -> vv.Scene:
    """A particle, a held body that is tilted, and a free one."""
    bodies = vv.RigidBodies(
        [1.0, 2.0],
        [[1.0, 1.0, 1.0], [1.0, 2.0, 2.5]],
        velocity=[[0.0, 0.0, 0.0], [7.0, 0.0, 0.0]],
        angular_velocity=[HELD["angular_velocity"], [0.0, 1.0, 0.0]],
        pivot=[HELD["pivot"], [np.nan] * 3],
        names=["top", "ball"],
    )
    return vv.Scene(
        vv.Particles([1.0], [[9.0, 0.0, 0.0]], [[5.0, 0.0, 0.0]]), bodies, vv.UniformField([0.0, 0.0, -1.0])
    )


def held(speed: float) -> vv.RigidBodies:
    return vv.RigidBody(1.0, [1.0, 1.0, 1.0], velocity=[0.0, speed, 0.0], **HELD)


@pytest.mark.parametrize(("off", "stays"), OFF)
def test_what_is_given_of_a_body_is_what_follows_or_stays(off: float, stays: bool) -> None:
    for sign in (1.0, -1.0):
        given = SPEED * (1.0 + sign * off)
        assert held(given).velocity.tolist() == [[0.0, given if stays else SPEED, 0.0]]
        with pytest.raises(
            vv.InvalidInput, match=r"^velocity: expected 0 .*what follows from its spin, \[0.0, 6.0, 0.0\]"
        ):
            held(SPEED * (1.0 + sign * TOO_FAR))


def test_what_is_given_of_copies_is_what_follows_or_stays() -> None:
    start = scene()
    velocity = np.repeat(start.particles.velocity[None], 2 * len(OFF) + 1, axis=0)
    given = [SPEED * (1.0 + sign * off) for off, _ in OFF for sign in (1.0, -1.0)]
    velocity[:-1, 1, 1] = given
    velocity[-1, 1] = 0.0
    velocity[:, 2, 0] = np.arange(len(velocity))  # of a free body it is what is given
    copies = start.ensemble(velocity=velocity)
    expected = velocity.copy()
    stays = [each for _, each in OFF for _ in range(2)]
    expected[:, 1, 1] = [*np.where(stays, given, SPEED), SPEED]
    found = np.array([copies[copy].particles.velocity for copy in range(len(velocity))])
    assert found.tolist() == expected.tolist()
    for sign in (1.0, -1.0):
        wrong = velocity.copy()
        wrong[3, 1, 1] = SPEED * (1.0 + sign * TOO_FAR)
        came = re.escape(str(wrong[3, 1].tolist()))
        with pytest.raises(
            vv.InvalidInput, match=rf"^velocity: .*\[0.0, 6.0, 0.0\], but that of top of copy 3 is {came}$"
        ):
            start.ensemble(velocity=wrong)


def test_copies_that_spin_otherwise_have_the_velocities_of_their_own_spins() -> None:
    """Where none is given, however far it is from that of the scene; free ones keep theirs."""
    start = scene()
    spins = np.array([[[0.0, 0.0, spin], [0.0, 1.0, 0.0]] for spin in (2.0, 0.0, -5.0)])
    copies = start.ensemble(angular_velocity=spins)
    for copy, spin in enumerate((2.0, 0.0, -5.0)):
        assert copies[copy].particles.velocity.tolist() == [[5.0, 0.0, 0.0], [0.0, 3.0 * spin, 0.0], [7.0, 0.0, 0.0]]


def test_a_center_that_is_faster_than_float64_is_refused_with_the_body_that_has_it() -> None:
    with pytest.raises(vv.InvalidInput, match=r"^pivot: .*speed is within float64 \(body 1\); choose other units"):
        vv.RigidBodies(
            [1.0, 1.0],
            [[1.0, 1.0, 1.0]] * 2,
            angular_velocity=[[0.0, 0.0, 2.0], [0.0, 0.0, 1e200]],
            pivot=[[-3.0, 0.0, 0.0], [0.0, -1e150, 0.0]],
        )


def test_free_bodies_alone_keep_any_velocity() -> None:
    assert vv.RigidBody(1.0, [1.0, 1.0, 1.0], velocity=[0.0, 5.0, 1.0]).velocity.tolist() == [[0.0, 5.0, 1.0]]
