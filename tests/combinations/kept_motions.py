"""Scenes that failed a law of motion or accuracy on the way: see `kept`."""

from __future__ import annotations

from recipe import Recipe

KEPT_MOTIONS: list[tuple[str, Recipe]] = [
    # An adaptive chunk took its masses from its first member: more than eight bodies, masses of their own.
    (
        "two_methods_agree",
        Recipe(method="dop853", bodies=9, massless=1, seed=46, members=9, own=("mass",), steps=4, outputs=1),
    ),
    ("two_methods_agree", Recipe(method="yoshida4", bodies=9, seed=413, members=9, own=("mass",), steps=4)),
    # The second Gravity took the constant of the first.
    ("declared_invariants_hold", Recipe(bodies=3, forces=(("Gravity", 42), ("Gravity", 76)), steps=8)),
    ("two_methods_agree", Recipe(bodies=2, forces=(("Gravity", 42), ("Gravity", 42)), steps=8)),
    # Störmer's kernel of two or three bodies took a repulsive constant for no mass.
    ("two_methods_agree", Recipe(method="stormer13", seed=2938, members=3, steps=2)),
    # A lone massive body beside massless ones in a uniform field had no size: NaN in the first step.
    (
        "two_methods_agree",
        Recipe(
            forces=(("UniformField", 4), ("Gravity", 12)),
            members=3,
            own=("mass",),
            own_massless=True,
            steps=4,
            outputs=1,
        ),
    ),
    # Far from the origin, gravity and a field: rounded coordinates kept the adaptive method from its tolerance.
    (
        "two_methods_agree",
        Recipe(
            bodies=38,
            forces=(("UniformField", 32), ("Gravity", 13)),
            planar=True,
            at_origin=True,
            offset=9,
            members=5,
            steps=8,
            outputs=1,
        ),
    ),
    # The acceleration of a scene lost digits about its center of mass.
    (
        "forces_add",
        Recipe(
            bodies=5, forces=(("PairPotential/3", 61), ("DrivenForce", 53)), seed=550, tame=False, planar=True, steps=4
        ),
    ),
    # The energy of a pair was formed in units in which its strength has two digits.
    (
        "declared_invariants_hold",
        Recipe(bodies=5, forces=(("PairPotential/3", 24),), units=(-310, -162, -13), steps=4, outputs=1),
    ),
    # A method of order 3 needs more steps for 1e-11 than the law allowed.
    (
        "two_methods_agree",
        Recipe(bodies=29, forces=(("PairPotential/3", 53),), seed=36, at_origin=True, members=8, steps=4),
    ),
    (
        "two_methods_agree",
        Recipe(
            method="dormand_prince54",
            bodies=2,
            forces=(("UniformField", 67), ("Gravity", 79), ("UniformField", 40)),
            seed=285,
            planar=True,
            at_origin=True,
            backward=True,
        ),
    ),
    # Laws that took steps too long for the scene: steps of a close pair, and an encounter that they miss.
    (
        "two_methods_agree",
        Recipe(
            method="kahan_li8",
            bodies=21,
            forces=(("PairPotential/3", 49),) * 2,
            seed=36620,
            tame=True,
            planar=True,
            at_origin=True,
            drifting=True,
            offset=7,
            members=11,
        ),
    ),
    (
        "two_methods_agree",
        Recipe(
            method="dormand_prince54",
            bodies=22,
            forces=(("PairPotential/3", 32), ("UniformField", 48), ("Spring", 48)),
            seed=149,
            tame=True,
            planar=True,
            at_origin=True,
            units=(-35, -33, -37),
        ),
    ),
    # Springs and a pull that is fixed in space, 1e8 away: the law took its rounding for errors of the steps.
    *(
        (
            law,
            Recipe(
                method="verner98", bodies=3, forces=(("Spring", 75), ("Harmonic", 85)), offset=8, steps=4, outputs=1
            ),
        )
        for law in ("two_methods_agree", "declared_invariants_hold")
    ),
    # The error of a body alone was measured by its distance from the origin, and not from the axis or the center of its
    # forces: a thousand times as large far away, most of all of one at rest.
    (
        "a_stopped_run_ends_where_the_whole_run_passes",
        Recipe(
            method="bogacki_shampine32",
            forces=(("RotatingFrame", 11), ("RotatingFrame", 2)),
            seed=2260,
            planar=True,
            at_origin=True,
            offset=6,
            members=9,
            decades=8,
            outputs=1,
            events=(("distance", 0), ("energy", 25), ("distance", 88)),
        ),
    ),
    (
        "a_scene_moves_alike_in_another_frame",
        Recipe(method="bogacki_shampine32", forces=(("RotatingFrame", 3),), seed=5, at_origin=True, offset=5),
    ),
    (
        "a_scene_moves_alike_in_another_frame",
        Recipe(method="bogacki_shampine32", bodies=1, forces=(("Harmonic", 8),), seed=8, at_origin=True, offset=6),
    ),
    # The acceleration of a scene was that at time 0, whenever the scene was.
    (
        "the_work_of_the_forces_is_the_kinetic_energy_gained",
        Recipe(method="midpoint", bodies=1, forces=(("DrivenForce", 82),), seed=391),
    ),
    # Run backward, a drag of any kind takes a body beyond what steps can follow: the law did it.
    (
        "declared_invariants_hold",
        Recipe(bodies=25, forces=(("CentralField", 0), ("SampledDrag", 0)), tame=False, steps=1, backward=True),
    ),
    # The first expansion of a series was in so short a unit of time that its coefficients lost digits: a velocity next
    # to nothing, 1e87 away.
    (
        "units_of_powers_of_two_change_no_bit",
        Recipe(
            method="taylor",
            bodies=3,
            forces=(("RotatingFrame", 36),),
            seed=57826,
            tame=False,
            at_origin=True,
            drifting=True,
            members=7,
            own=("mass", "numbers", "position", "parameters", "radius", "velocity"),
            wild_member=True,
            steps=5,
            ragged=True,
            decades=12,
            outputs=1,
            backward=True,
        ),
    ),
    # Steps in another time came to the end but for what rounding leaves out, and one more was taken through that.
    (
        "final_is_the_last_state",
        Recipe(
            method="yoshida4",
            bodies=1,
            forces=(("Coulomb", 86), ("DrivenForce", 9)),
            seed=366,
            drifting=True,
            steps=39,
            transformation="distance",
        ),
    ),
    # The stats of a copy whose numbers ceased to be were those of the others beside it.
    (
        "a_member_is_as_if_alone",
        Recipe(
            method="heun",
            bodies=3,
            forces=(("Gravity", 88), ("DrivenForce", 54), ("QuadraticDrag", 26)),
            seed=2569,
            tame=False,
            planar=True,
            drifting=True,
            members=9,
            own=("parameters", "mass", "numbers", "radius", "position", "velocity"),
            steps=23,
            outputs=1,
            events=(("distance", 83),),
            t0=41.888855517907984,
            backward=True,
        ),
    ),
    # An energy beyond numbers, of velocities of 1e201: the law took it for a failure.
    (
        "what_is_ok_is_finite",
        Recipe(
            method="euler",
            forces=(("UniformMagneticField", 3), ("QuadraticDrag", 71), ("QuadraticDrag", 71)),
            seed=2171,
            tame=False,
            planar=True,
            drifting=True,
            steps=15,
            columns=("energy",),
            events=(("energy", 97),),
            terminal=1,
            backward=True,
        ),
    ),
    # A center's k/m vanished below the least number, and the closed form went straight on.
    ("a_closed_form_is_what_integration_gives", Recipe(seed=879, units=(-310, 187, 110), backward=True)),
    # The law's other frame had a velocity of 4 in units in which bodies have 1e-86.
    (
        "a_scene_moves_alike_in_another_frame",
        Recipe(method="rk4", bodies=20, massless=3, forces=(("Gravity", 27),), seed=518, units=(5, 276, 288)),
    ),
]
