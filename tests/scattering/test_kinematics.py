"""Two-body kinematics: closure, limits, both frames and back, and numbers of 40 digits.

Bounds: a few roundings of sines and tangents; the energy at an angle is found by its branch, to the root of a
rounding where both meet.
"""

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import visviva as vv

s = vv.scattering
angles_cm = st.floats(0.0, np.pi)
ratios = st.floats(-6.0, 6.0).map(lambda power: 10.0**power)


def exact(
    psi: float, mass: float, products: tuple[float, float], energy: float, q: float
) -> tuple[tuple[mp.mpf, mp.mpf], dict[str, mp.mpf]]:
    """Everything from the velocities, in 60 digits: momentum and energy of the laboratory, and nothing else."""
    with mp.workdps(60):
        m1, m3, m4, energy, q, psi = (mp.mpf(x) for x in (mass, *products, energy, q, psi))
        total = m3 + m4
        frame = mp.sqrt(2 * m1 * energy) / total
        left = energy + q - total * frame**2 / 2
        relative = mp.sqrt(2 * left * total / (m3 * m4))
        w3, w4 = m4 / total * relative, m3 / total * relative
        v3 = (frame + w3 * mp.cos(psi), w3 * mp.sin(psi))
        v4 = (frame - w4 * mp.cos(psi), w4 * mp.sin(psi))

        def jacobian(w: mp.mpf, cosine: mp.mpf, v: tuple[mp.mpf, mp.mpf]) -> mp.mpf:
            return (v[0] ** 2 + v[1] ** 2) ** mp.mpf("1.5") / (w**2 * abs(w + frame * cosine))

        edges = abs(w3 + frame * mp.cos(psi)) / (w3 + frame), abs(w4 - frame * mp.cos(psi)) / (w4 + frame)
        return edges, {
            "lab_angle": mp.atan2(v3[1], v3[0]),
            "recoil_angle": mp.atan2(v4[1], v4[0]),
            "opening_angle": mp.atan2(v3[1], v3[0]) + mp.atan2(v4[1], v4[0]),
            "energy_kept": m3 * (v3[0] ** 2 + v3[1] ** 2) / (2 * energy),
            "energy_transfer": m4 * (v4[0] ** 2 + v4[1] ** 2) / (2 * energy),
            "lab_jacobian": jacobian(w3, mp.cos(psi), v3),
            "recoil_jacobian": jacobian(w4, -mp.cos(psi), v4),
        }


@given(ratios, st.floats(1e-9, 3.14), st.sampled_from(["loss", "gain", "none"]), st.floats(1e-6, 0.999), st.booleans())
def test_every_function_against_sixty_digits(ratio: float, psi: float, kind: str, part: float, changed: bool) -> None:
    """Relative to 4e-15, at any decade of the masses and any Q-value."""
    products = (0.75 * ratio, 1.0 + 0.25 * ratio) if changed else (ratio, 1.0)
    share = (sum(products) - ratio) / sum(products)
    q = {"loss": -part * share, "gain": part, "none": 0.0}[kind]
    given = {"mass_ratio": ratio, "q_value": q, "beam_energy": 1.0, "products": products if changed else None}
    edges, reference = exact(psi, ratio, products, 1.0, q)
    for name, expected in reference.items():
        found = float(getattr(s, name)(psi, **given))
        # Measured 1e-15 over 4000 draws. A jacobian is infinite where a body's own velocity is across its direction;
        # next to that a rounding of ψ counts as often as it is near.
        edge = {"lab_jacobian": edges[0], "recoil_jacobian": edges[1]}.get(name)
        slack = 4e-15 if edge is None else 4e-15 / float(edge)
        assert abs(found - float(expected)) <= slack * abs(float(expected)), (name, found, expected)


@given(ratios, angles_cm, st.floats(-0.999, 3.0))
def test_momentum_and_energy_close(ratio: float, psi: float, released: float) -> None:
    """p₁ = p₃ + p₄ along and across the beam and E₁ + Q = E₃ + E₄, to 1e-14 of what is added."""
    q = released / (1.0 + ratio) if released < 0.0 else released
    given = {"mass_ratio": ratio, "q_value": q, "beam_energy": 1.0}
    kept, taken = s.energy_kept(psi, **given), s.energy_transfer(psi, **given)
    assert kept + taken == pytest.approx(1.0 + q, rel=0.0, abs=1e-14 * (1.0 + abs(q)))
    here, there = s.lab_angle(psi, **given), s.recoil_angle(psi, **given)
    mine, theirs = np.sqrt(kept), np.sqrt(taken / ratio)
    size = 1.0 + mine + theirs
    assert abs(mine * np.sin(here) - theirs * np.sin(there)) < 1e-14 * size
    assert abs(mine * np.cos(here) + theirs * np.cos(there) - 1.0) < 1e-14 * size


@given(ratios, st.floats(0.01, 3.13), st.floats(-0.99, 3.0))
def test_laboratory_angles_lead_back(ratio: float, psi: float, released: float) -> None:
    q = released / (1.0 + ratio) if released < 0.0 else released
    given = {"mass_ratio": ratio, "q_value": q, "beam_energy": 1.0}
    for forth, back, jacobian in (
        (s.lab_angle, s.cm_angle, s.lab_jacobian),
        (s.recoil_angle, s.cm_angle_from_recoil, s.recoil_jacobian),
    ):
        density = jacobian(psi, **given)
        if 1e-4 < density < 1e4:  # beyond, an angle is known to its rounding times the root of it
            found = np.array(back(forth(psi, **given), **given))
            assert np.nanmin(np.abs(found - psi)) < 1e-9


@given(ratios, st.floats(0.01, 3.13), st.floats(-0.99, 3.0))
def test_what_an_angle_has_of_energy_is_what_its_branches_have(ratio: float, psi: float, released: float) -> None:
    q = released / (1.0 + ratio) if released < 0.0 else released
    given = {"mass_ratio": ratio, "q_value": q, "beam_energy": 1.0}
    if not 1e-4 < s.lab_jacobian(psi, **given) < 1e4:
        return
    theta = min(s.lab_angle(psi, **given), s.greatest_lab_angle(**given))
    energies = [s.kinematic_factor(theta, **given)]
    if s.greatest_lab_angle(**given) < np.pi / 2.0:
        energies.append(s.kinematic_factor(theta, branch="slow", **given))
        assert energies[0] >= energies[1]
    kept = s.energy_kept(psi, **given)
    assert min(abs(energy - kept) for energy in energies) < 2e-13 * s.energy_kept(0.0, **given)


@given(ratios, angles_cm, st.floats(-0.99, 3.0))
def test_time_reversal(ratio: float, psi: float, released: float) -> None:
    """Detailed balance: what was released is taken up on the way back, in the frame of the center of mass."""
    speed = np.sqrt(1.0 + released)
    forth = vv.collisions.inelastic(
        ratio, 1.0, [1 / (1 + ratio), 0, 0], [-ratio / (1 + ratio), 0, 0],
        q_value=0.5 * released * ratio / (1 + ratio), direction=[np.cos(psi), np.sin(psi), 0.0],
    )  # fmt: skip
    back = vv.collisions.inelastic(
        ratio, 1.0, -forth.velocity1, -forth.velocity2, q_value=forth.energy_loss, direction=[-1.0, 0.0, 0.0]
    )
    # A small speed afterwards is the difference of large ones.
    slack = 1e-14 * (1.0 + speed) / min(1.0, speed) ** 2
    assert back.velocity1 == pytest.approx([-1 / (1 + ratio), 0, 0], abs=slack)
    assert back.velocity2 == pytest.approx([ratio / (1 + ratio), 0, 0], abs=slack)


def test_numbers_of_the_research_file() -> None:
    """m₁/m₂ = 2, alpha particles on protons, m₁ = 1 on m₂ = 4 with Q = −1, and ⁷Li(p, n): to the digits given."""
    assert np.degrees(s.greatest_lab_angle(mass_ratio=2.0)) == pytest.approx(30.0, rel=1e-15, abs=0)
    assert np.degrees(s.lab_angle(np.radians(120.0), mass_ratio=2.0)) == pytest.approx(30.0, rel=1e-14, abs=0)
    both = [s.kinematic_factor(np.radians(20.0), mass_ratio=2.0, branch=which) for which in ("fast", "slow")]
    assert both == pytest.approx([0.756221246368, 0.146929369738], abs=5.1e-13)
    # Nuclear masses of the alpha particle and of the proton in u.
    alpha, proton = 4.001506179, 1.007276467
    assert np.degrees(s.greatest_lab_angle(mass_ratio=alpha / proton)) == pytest.approx(14.57957, abs=5.1e-6)
    given = {"mass_ratio": 0.25, "q_value": -1.0}
    assert s.threshold_energy(**given) == 1.25
    assert np.degrees(s.greatest_lab_angle(beam_energy=1.26, **given)) == pytest.approx(20.8761026, abs=5.1e-8)
    assert s.two_branch_energy(**given) == pytest.approx(4.0 / 3.0, rel=1e-15, abs=0)
    lithium = 7.014357
    assert s.threshold_energy(mass_ratio=proton / lithium, q_value=-1.64424) == pytest.approx(1.88036, abs=5.1e-6)


def test_the_branches_of_an_endoergic_collision_begin_and_end() -> None:
    given = {"mass_ratio": 0.25, "q_value": -1.0}
    edge = float(s.two_branch_energy(**given))
    for factor, two in ((1.0 - 1e-9, True), (1.0 + 1e-9, False)):
        greatest = s.greatest_lab_angle(beam_energy=edge * factor, **given)
        assert (greatest < np.pi / 2.0) == two
        _, second = s.cm_angle(0.1, beam_energy=edge * factor, **given)
        assert np.isfinite(second) == two
    # At the threshold they go on together, at the speed of the center of mass: E₁ = m₁²/(m₁+m₂)² E₀.
    there = {"beam_energy": 1.25} | given
    assert s.greatest_lab_angle(**there) == 0.0
    for psi in (0.0, 1.0, np.pi):
        assert (s.lab_angle(psi, **there), s.opening_angle(psi, **there)) == (0.0, 0.0)
        assert s.energy_kept(psi, **there) == pytest.approx(0.04, rel=1e-15, abs=0)
    # A little above, sin θ = (m₂/m₁) √(1 − E_th/E): to the last digits of what is left.
    for excess in (1e-10, 2.0**-51):
        energy = 1.25 * (1.0 + excess)
        with mp.workdps(40):
            exact_angle = float(mp.asin(4 * mp.sqrt(1 - mp.mpf(1.25) / mp.mpf(energy))))
        assert s.greatest_lab_angle(beam_energy=energy, **given) == pytest.approx(exact_angle, rel=1e-15, abs=0.0)


@pytest.mark.parametrize("ratio", [1e-300, 1e-9, 0.5, 1.0, 2.0, 1e9, 1e300])
@pytest.mark.parametrize("psi", [0.0, 5e-324, 1e-160, 1e-8, 1.0, 3.0, np.pi])
def test_nothing_is_lost_at_the_ends(ratio: float, psi: float) -> None:
    """From a target that never moves to one that is nothing, from forward to head-on: no NaN, and the limits."""
    given = {"mass_ratio": ratio}
    theta, recoil = s.lab_angle(psi, **given), s.recoil_angle(psi)
    opening = s.opening_angle(psi, **given)
    assert opening == pytest.approx(theta + recoil, rel=1e-15, abs=0)
    assert s.energy_kept(psi, **given) + s.energy_transfer(psi, **given) == pytest.approx(1.0, rel=1e-15, abs=0)
    for q in (1e-18, -1e-18):
        near = {"q_value": q / (1.0 + ratio), "beam_energy": 1.0} | given
        assert s.lab_angle(psi, **near) == pytest.approx(theta, rel=1e-14, abs=1e-320) or psi > 1e-7
        assert s.energy_kept(psi, **near) == pytest.approx(s.energy_kept(psi, **given), rel=1e-15, abs=1e-15)
    if ratio == 1.0:
        assert opening == np.pi / 2.0
        assert theta == psi / 2.0 or psi > 1e-8
    if ratio == 1e-300:
        # The least number that there is may come out as 0; pytest's own absolute tolerance is 1e-12.
        assert theta == pytest.approx(psi, rel=4e-16, abs=5e-324)
        assert s.lab_jacobian(psi, **given) == pytest.approx(1.0, rel=1e-15, abs=0)
    if 1e-160 <= psi <= 1e-8 and ratio <= 1e9:
        assert theta == pytest.approx(psi / (1.0 + ratio), rel=1e-14, abs=0.0)


def test_arguments_broadcast_against_each_other() -> None:
    psi, ratio = np.linspace(0.1, 3.0, 5)[:, None], np.asfortranarray([[0.5, 1.0, 2.0]])
    energy = np.linspace(4.0, 5.0, 10)[::5].reshape(2, 1, 1)
    table = s.lab_angle(psi, mass_ratio=ratio, q_value=-1.0, beam_energy=energy)
    assert table.shape == (2, 5, 3)
    for i, j, k in np.ndindex(table.shape):
        one = s.lab_angle(psi[j, 0], mass_ratio=ratio[0, k], q_value=-1.0, beam_energy=energy[i, 0, 0])
        assert isinstance(one, float)
        assert table[i, j, k] == one
    assert s.lab_angle(np.empty((0, 2)), mass_ratio=1.0).shape == (0, 2)
    assert s.threshold_energy(mass_ratio=[0.25, 1.0], q_value=[[-1.0], [1.0]]).tolist() == [[1.25, 2.0], [0.0, 0.0]]
    assert s.recoil_angle([1.0, 2.0]).shape == (2,)


def test_isotropic_collisions_have_the_averages_of_moderation() -> None:
    """Gauss–Legendre over cos ψ: exact for what is a polynomial in it, 1e-13 for logarithm and root off the edges."""
    nodes, weights = np.polynomial.legendre.leggauss(64)
    psi = np.arccos(nodes)
    for ratio in (1e-3, 0.25, 0.6, 3.0, 200.0):
        of = s.moderation(mass_ratio=ratio)
        assert of.greatest_transfer == s.energy_transfer(np.pi, mass_ratio=ratio)
        assert of.mean_transfer == pytest.approx(
            weights @ s.energy_transfer(psi, mass_ratio=ratio) / 2.0, rel=1e-13, abs=0
        )
        kept = s.energy_kept(psi, mass_ratio=ratio)
        assert of.mean_logarithmic_decrement == pytest.approx(-(weights @ np.log(kept)) / 2.0, rel=1e-11, abs=0)
        cosine = weights @ np.cos(s.lab_angle(psi, mass_ratio=ratio)) / 2.0
        assert of.mean_cosine == pytest.approx(cosine, rel=1e-11, abs=0)
    equal = s.moderation(mass_ratio=1.0)
    assert (equal.mean_logarithmic_decrement, equal.mean_transfer, equal.mean_cosine) == (1.0, 0.5, 2.0 / 3.0)
    with mp.workdps(50):
        for ratio in (1e-12, 0.1, 0.17, 0.18, 0.9, 1.0 + 1e-9):
            q = 4 * mp.mpf(ratio) / (1 + mp.mpf(ratio)) ** 2
            exact = 1 + (1 - q) / q * mp.log(1 - q)
            found = s.moderation(mass_ratio=ratio).mean_logarithmic_decrement
            assert found == pytest.approx(float(exact), rel=3e-15, abs=0)


@pytest.mark.parametrize(
    ("argument", "message", "call"),
    [
        ("beam_energy", "threshold, 1.25,", lambda: s.lab_angle(1, mass_ratio=0.25, q_value=-1, beam_energy=1.2499)),
        ("beam_energy", "entry 1 of 2", lambda: s.lab_angle(1.0, mass_ratio=0.25, q_value=-1.0, beam_energy=[2, 1])),
        ("beam_energy", "q_value needs", lambda: s.lab_angle(1.0, mass_ratio=0.25, q_value=-1.0)),
        ("beam_energy", "products needs", lambda: s.lab_angle(1.0, mass_ratio=0.25, products=(0.25, 1.0))),
        ("beam_energy", "positive", lambda: s.lab_angle(1.0, mass_ratio=0.25, q_value=1.0, beam_energy=0.0)),
        ("mass_ratio", "need, got None", lambda: s.recoil_angle(1.0, q_value=1.0, beam_energy=1.0)),
        ("mass_ratio", r"got -1.0 at mass_ratio\[1\]", lambda: s.lab_angle(1.0, mass_ratio=[1.0, -1.0])),
        ("mass_ratio", "broadcast", lambda: s.lab_angle([1.0, 2.0], mass_ratio=[1.0, 1.0, 1.0])),
        ("products", "tuple", lambda: s.lab_angle(1.0, mass_ratio=1.0, products=1.0, beam_energy=1.0)),
        ("products", "more mass", lambda: s.lab_angle(1.0, mass_ratio=4.0, products=(1.0, 1.0), beam_energy=1.0)),
        ("lab_angle", r"in \[0, 0.5235987755982989\], got 0.6", lambda: s.kinematic_factor(0.6, mass_ratio=2.0)),
        ("branch", "only one energy", lambda: s.kinematic_factor(0.6, mass_ratio=0.5, branch="slow")),
        ("branch", "did you mean 'fast'", lambda: s.kinematic_factor(0.6, mass_ratio=0.5, branch="Fast")),
        ("q_value", "finite", lambda: s.threshold_energy(mass_ratio=1.0, q_value=np.nan)),
        ("cm_angle", r"\[0, π\]", lambda: s.opening_angle(4.0, mass_ratio=1.0)),
    ],
)  # fmt: skip
def test_refusals(argument: str, message: str, call: object) -> None:
    with pytest.raises(vv.InvalidInput, match=message) as caught:
        call()  # type: ignore[operator]
    assert caught.value.argument == argument


@pytest.mark.parametrize("angle", [1e-9, 1e-6, 1e-3, 0.1])
def test_both_branches_of_small_recoils_keep_their_digits(angle: float) -> None:
    """Where something is taken up a recoil has two; recoil_angle, which both lead back to, is exact in small angles."""
    how = {"mass_ratio": 0.0376, "beam_energy": 0.277, "q_value": -0.091}
    ahead, back = s.cm_angle_from_recoil(angle, **how)
    assert s.recoil_angle(back, **how) == pytest.approx(angle, rel=1e-14, abs=0.0)
    # Beside π an angle has as many digits as that.
    assert s.recoil_angle(ahead, **how) == pytest.approx(angle, rel=1e-14, abs=1e-15)
