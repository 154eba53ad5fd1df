"""Scenes that failed a law on the way, as plain as the failure lets them be, with what was wrong."""

from __future__ import annotations

from kept_events import KEPT_EVENTS
from kept_found import KEPT_FOUND
from kept_motions import KEPT_MOTIONS
from recipe import Recipe

KEPT: list[tuple[str, Recipe]] = [
    *KEPT_MOTIONS,
    *KEPT_EVENTS,
    *KEPT_FOUND,
    # An adaptive chunk took its masses from its first member: more than eight bodies, masses of their own.
    (
        "threads_change_no_bit",
        Recipe(bodies=9, massless=7, seed=809, members=9, own=("mass",), own_massless=True, steps=4),
    ),
    (
        "tiers_change_no_bit",
        Recipe(bodies=9, massless=7, seed=809, members=9, own=("mass",), own_massless=True, steps=4),
    ),
    # The state was shaped for the massive bodies alone: index out of bounds.
    ("a_member_is_as_if_alone", Recipe(bodies=9, massless=1, members=5, steps=8)),
    ("threads_change_no_bit", Recipe(bodies=3, crowd=210, steps=8)),
    # `final` forgot what the state leaves out.
    # Bodies at rest had the plan's unit for a velocity scale.
    (
        "a_member_is_as_if_alone",
        Recipe(
            method="dop853",
            bodies=9,
            forces=(("UniformField", 68), ("UniformField", 20), ("UniformField", 68)),
            seed=3,
            tame=False,
            members=23,
            steps=1,
            ragged=True,
            decades=5,
            columns=("position",),
        ),
    ),
    (
        "units_of_powers_of_two_change_no_bit",
        Recipe(method="dop853", bodies=3, forces=(("UniformField", 45),), tame=False, steps=8, outputs=1),
    ),
    # Members of several make-ups: the total was that of the last of them.
    (
        "progress_ends_at_its_total",
        Recipe(method="kahan_li8", bodies=5, forces=(), members=3, own=("mass",), own_massless=True, steps=8),
    ),
    # Lanes without a body fell in a uniform field and entered the error of a step.
    (
        "a_member_is_as_if_alone",
        Recipe(
            bodies=2,
            forces=(("CentralField/3", 0), ("Gravity", 0), ("UniformField", 0)),
            tame=False,
            members=3,
            steps=1,
            decades=5,
        ),
    ),
    # A lone massive body that drag slows down had the unit of length for a size.
    (
        "units_of_powers_of_two_change_no_bit",
        Recipe(
            bodies=4, massless=3, forces=(("Gravity", 0), ("LinearDrag", 0)), seed=0, tame=False, steps=1, decades=5
        ),
    ),
    # One massive body was held to another error where massless ones felt it.
    (
        "massless_bodies_do_not_touch_the_massive",
        Recipe(method="dop853", bodies=15, massless=14, forces=(("LinearDrag", 49), ("Gravity", 1)), steps=8),
    ),
    # Bodies that went on where another one of their member had failed were still in the rows beyond.
    (
        "a_member_is_as_if_alone",
        Recipe(
            method="bogacki_shampine32",
            bodies=5,
            forces=(("CentralField/3", 29),),
            tame=False,
            steps=4,
            decades=12,
            outputs=1,
        ),
    ),
    # A slow, large member with strong springs: its first step was beyond measure in its own unit of time.
    (
        "units_of_powers_of_two_change_no_bit",
        Recipe(
            bodies=9,
            forces=(("PairPotential/3", 25), ("Spring", 80)),
            tame=False,
            members=3,
            wild_member=True,
            steps=4,
        ),
    ),
    (
        "units_of_powers_of_two_change_no_bit",
        Recipe(forces=(("PairPotential/3", 25), ("Spring", 80)), tame=False, members=1, wild_member=True, steps=4),
    ),
    # Members in lockstep paid for the looks into steps of each other, and for steps after their own end.
    (
        "a_member_is_as_if_alone",
        Recipe(method="rk4", forces=(), members=3, steps=4, events=(("plane", 0), ("distance", 2), ("apsis", 26))),
    ),
    (
        "a_member_is_as_if_alone",
        Recipe(
            method="leapfrog",
            bodies=3,
            seed=1,
            members=5,
            steps=8,
            events=(("plane", 1), ("distance", 1)),
            terminal=1,
        ),
    ),
    # A massive body had other sizes alone than with massless ones that follow it.
    (
        "massless_bodies_do_not_touch_the_massive",
        Recipe(
            method="bogacki_shampine32",
            bodies=3,
            massless=2,
            forces=(("LinearDrag", 8), ("Gravity", 53)),
            seed=3926,
            steps=16,
        ),
    ),
    # Members' bodies were judged by the events of the first body that was looked at.
    (
        "a_member_is_as_if_alone",
        Recipe(
            method="dormand_prince54",
            bodies=11,
            forces=(("DrivenForce", 78), ("UniformField", 73), ("CentralField/3", 32)),
            seed=55,
            drifting=True,
            units=(-53, 55, 35),
            own=("mass", "position"),
            steps=36,
            decades=6,
            outputs=3,
            events=(("plane", 0), ("plane", 91), ("apsis", 88)),
            terminal=2,
            t0=87.32558633649637,
        ),
    ),
    (
        "a_member_is_as_if_alone",
        Recipe(
            method="leapfrog",
            bodies=9,
            massless=9,
            forces=(),
            tame=False,
            units=(0, 0, 1),
            members=11,
            own=("position", "velocity", "mass"),
            steps=36,
            decades=6,
            outputs=4,
            events=(("plane", 90), ("distance", 90), ("plane", 82)),
            terminal=1,
            t0=47.154297734472124,
            backward=True,
        ),
    ),
    (
        "a_run_goes_on_with_the_bits_of_the_whole",
        Recipe(method="rk4", bodies=9, forces=(("PairPotential/3", 50),), seed=104, tame=False, planar=True, members=3),
    ),
    (
        "progress_ends_at_its_total",
        Recipe(
            bodies=32,
            forces=(("PairPotential/3", 88), ("PairPotential/3", 91)),
            seed=870,
            tame=False,
            planar=True,
            units=(-39, 217, -87),
            members=7,
            own=("velocity",),
            own_massless=True,
            steps=34,
            t0=98.77516752189527,
        ),
    ),
    (
        "a_located_event_is_a_zero_at_its_state",
        Recipe(
            bodies=2,
            forces=(("UniformField", 62), ("UniformField", 62)),
            seed=48263,
            at_origin=True,
            drifting=True,
            members=5,
            outputs=1,
            t0=-82.772372693838,
            backward=True,
        ),
    ),
    (
        "units_of_powers_of_two_change_no_bit",
        Recipe(
            bodies=3,
            forces=(("CentralField/3", 76),),
            seed=4266,
            tame=False,
            at_origin=True,
            offset=8,
            members=10,
            own=("velocity", "position"),
            wild_member=True,
        ),
    ),
    (
        "no_step_is_longer_than_max_step",
        Recipe(
            bodies=8,
            massless=5,
            forces=(("Gravity", 90),),
            seed=41,
            tame=False,
            planar=True,
            drifting=True,
            offset=6,
            units=(-112, 223, -191),
            members=28,
            own=("velocity", "mass", "position"),
            own_massless=True,
            wild_member=True,
            steps=21,
            outputs=1,
            t0=-93.02393099744823,
            backward=True,
        ),
    ),
    (
        "events_change_no_bit_of_the_run",
        Recipe(
            method="dormand_prince54",
            bodies=19,
            massless=12,
            tame=False,
            planar=True,
            offset=5,
            members=9,
            own=("mass", "position", "velocity"),
            own_massless=True,
            steps=4,
            outputs=1,
        ),
    ),
    # A law that asked for the same last state where numbers ceased to be after another output.
    (
        "other_outputs_change_no_bit",
        Recipe(
            method="euler",
            bodies=27,
            forces=(("UniformField", 15), ("UniformField", 15), ("QuadraticDrag", 46)),
            seed=50447,
            tame=False,
            drifting=True,
            steps=11,
            ragged=True,
            outputs=1,
            columns=("position", "velocity"),
        ),
    ),
    # A massive body without another one had nothing by which its time could go.
    (
        "steps_in_another_time_lead_to_the_same_motion",
        Recipe(
            method="leapfrog",
            massless=1,
            forces=(("Gravity", 62),),
            seed=205,
            tame=False,
            at_origin=True,
            members=29,
            own=("mass", "parameters", "position"),
            steps=32,
            ragged=True,
            transformation="distance",
        ),
    ),
    # Massless bodies of some members were refused by the run and not by the plan.
    (
        "refusals_are_made_by_the_plan_and_by_the_run",
        Recipe(
            method="sofroniou_spaletta6",
            bodies=9,
            forces=(("Gravity", 5),),
            seed=34245,
            tame=False,
            members=21,
            own=("mass",),
            own_massless=True,
            transformation="potential_energy",
        ),
    ),
    # Why a step in another time had no end was told by a size that nobody had measured.
    (
        "units_of_powers_of_two_change_no_bit",
        Recipe(
            method="yoshida8",
            bodies=9,
            forces=(("Gravity", 31), ("UniformField", 16)),
            seed=34245,
            tame=False,
            planar=True,
            at_origin=True,
            drifting=True,
            offset=1,
            members=21,
            own_massless=True,
            steps=1,
            transformation="distance",
            columns=("position",),
        ),
    ),
]
