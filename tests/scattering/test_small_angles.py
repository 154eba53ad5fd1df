"""Cross sections at angles as small as one likes, and at zero: what has a tail deflects at every distance.

Bounds: closed forms of a few operations, and an inverse that ends at some hundred roundings.
"""

import numpy as np
import pytest

import visviva as vv

S, V = vv.scattering, vv.potentials
COULOMB = V.Coulomb(1.0)


@pytest.mark.parametrize("angle", [1e-3, 1e-7, 1.1e-7, 1e-8, 1e-12, 1e-100])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_coulomb_is_rutherford_down_to_any_angle(angle: float, sign: float) -> None:
    """The grid of impact parameters ended at 2²⁴ of a length: nothing was found beyond."""
    potential, energy = V.Coulomb(sign), 0.5
    wanted = S.rutherford_cross_section(COULOMB, energy=energy, angle=angle)
    assert S.cross_section(potential, energy=energy, angle=angle) == pytest.approx(wanted, rel=1e-14, abs=0)
    cotangent = 1.0 / np.tan(0.5 * angle)
    assert S.impact_parameter(potential, energy=energy, angle=angle) == pytest.approx([cotangent], rel=1e-14, abs=0)
    total = S.total_cross_section(potential, energy=energy, theta_min=angle)
    assert total == pytest.approx(np.pi * cotangent**2, rel=1e-14, abs=0)


@pytest.mark.parametrize("angle", [1e-9, 1e-12, 1e-15, 1e-30])
def test_the_tail_of_lennard_jones(angle: float) -> None:
    """ψ = −(15π/4) ε σ⁶/(E b⁶), and the next order falls as (σ/b)⁶; outside of the rainbow there is one branch."""
    strength = 15.0 * np.pi / 4.0
    b = (strength / angle) ** (1.0 / 6.0)
    potential = V.LennardJones(1.0, 1.0)
    assert S.impact_parameter(potential, energy=1.0, angle=angle)[-1] == pytest.approx(b, rel=angle + 1e-12, abs=0)
    outer = b / (angle * 6.0 * angle / b)
    assert S.cross_section(potential, energy=1.0, angle=angle) == pytest.approx(outer, rel=1e-5 + 10 * angle, abs=0)
    assert S.total_cross_section(potential, energy=1.0, theta_min=angle) == pytest.approx(
        np.pi * b * b, rel=1e-2, abs=0
    )


TAILS = [
    COULOMB,
    V.Coulomb(-1.0),
    V.LennardJones(1.0, 1.0),
    V.Yukawa(1.0, 1.0),
    V.PowerLaw(1.0, 1.5),
    V.PowerLaw(-1.0, 1.5),
    V.PowerLaw(1.0, 3.0),
    V.Morse(1.0, 1.5, 1.0),
    V.Buckingham(1.3, 0.7, 2.0),
]


@pytest.mark.parametrize("potential", TAILS, ids=lambda potential: type(potential).__name__)
def test_it_is_infinite_straight_on_where_a_potential_ends_nowhere(potential: V.Potential) -> None:
    assert S.cross_section(potential, energy=1.0, angle=0.0) == np.inf
    assert S.total_cross_section(potential, energy=1.0, theta_min=0.0) == np.inf
    # Ever more towards it, and never nothing.
    angles = 10.0 ** -np.arange(3.0, 40.0)
    found = S.cross_section(potential, energy=1.0, angle=angles)
    assert (np.diff(found) > 0.0).all()
    assert (np.diff([S.total_cross_section(potential, energy=1.0, theta_min=angle) for angle in angles]) > 0.0).all()


def test_what_ends_has_an_area() -> None:
    assert S.total_cross_section(V.HardSphere(2.0), energy=1.0, theta_min=0.0) == pytest.approx(
        4 * np.pi, rel=1e-14, abs=0
    )
    # What grazes it turns by as little as one likes: R²/4, to the two digits that R − b has there.
    assert S.cross_section(V.HardSphere(2.0), energy=1.0, angle=0.0) == pytest.approx(1.0, rel=1e-2)
    # A soft center turns nothing back, and that is no negative zero.
    assert str(S.cross_section(V.Plummer(0.1, 1.0), energy=1.0, angle=3.0)) == "0.0"


def test_plummers_tail_is_coulombs() -> None:
    found = S.cross_section(V.Plummer(-1.0, 0.5), energy=0.5, angle=1e-8)
    # b is 1e8 there, and (a/b)² = 2.5e-17 of the force is missing: rounding; measured 2.2e-15.
    assert found == pytest.approx(S.rutherford_cross_section(COULOMB, energy=0.5, angle=1e-8), rel=2e-14, abs=0)


def test_recoils_across_the_beam_and_rare_large_angles() -> None:
    recoil = S.cross_section(COULOMB, energy=0.5, angle=np.pi / 2 - 1e-9, frame="recoil")
    # 4 cos α of the cross section at π − 2α.
    wanted = 4e-9 * S.rutherford_cross_section(COULOMB, energy=0.5, angle=2e-9)
    assert recoil == pytest.approx(wanted, rel=1e-6, abs=0)
    counted = S.monte_carlo(
        COULOMB,
        beam_energy=1.0,
        masses=(1, 1e9),
        b_max=1e9,
        n_events=10,
        seed=1,
        importance=S.LargeAngles(3e-9),
    )
    assert counted.n_events == 10


@pytest.mark.parametrize("orders", [(1, 1), (2, 2), (1, 5), (1, 10), (2, 12), (1, 16), (2, 20)])
def test_collision_integrals_of_hard_spheres_are_one(orders: tuple[int, int]) -> None:
    """The higher the order, the more great energies count; a fixed end of the integral left out 4e-6 at s = 20."""
    found = S.collision_integral(V.HardSphere(1.0), temperature=1.0, diameter=1.0, orders=orders)
    assert found == pytest.approx(1.0, rel=1e-10)
