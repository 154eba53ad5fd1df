"""Scenes that failed a law of events on the way: see `kept`."""

from __future__ import annotations

from recipe import Recipe

KEPT_EVENTS: list[tuple[str, Recipe]] = [
    # Between nodes of fixed steps events looked at shadow steps taken backward: a jump of their error at the start.
    (
        "a_located_event_is_a_zero_at_its_state",
        Recipe(
            method="rk4",
            bodies=5,
            forces=(("UniformMagneticField", 59),) * 3,
            seed=106,
            tame=True,
            offset=1,
            steps=1,
            decades=5,
            columns=("position",),
            backward=True,
        ),
    ),
    (
        "a_terminal_event_only_cuts",
        Recipe(
            method="rk4",
            bodies=10,
            forces=(("UniformMagneticField", 33),),
            seed=405,
            tame=False,
            drifting=True,
            members=9,
            steps=2,
            events=(("plane", 33), ("plane", 81)),
            backward=True,
        ),
    ),
    (
        "a_terminal_event_only_cuts",
        Recipe(
            method="rk4",
            bodies=3,
            forces=(("CentralField/3", 6),),
            seed=633,
            tame=False,
            at_origin=True,
            offset=9,
            members=5,
            steps=4,
            outputs=1,
            backward=True,
        ),
    ),
    (
        "a_terminal_event_only_cuts",
        Recipe(
            method="stormer13",
            bodies=5,
            massless=2,
            forces=(("Gravity", 0),),
            seed=0,
            tame=True,
            steps=2,
            outputs=1,
            events=(("distance", 3), ("energy", 72), ("plane", 84)),
        ),
    ),
    # An event at the very node of an output took the row with it.
    (
        "a_terminal_event_only_cuts",
        Recipe(
            method="euler",
            bodies=5,
            forces=(("PostNewtonian", 47),),
            seed=335,
            tame=False,
            planar=True,
            at_origin=True,
            offset=1,
            steps=1,
        ),
    ),
    # A massless body's event was taken for one on steps of all, which it is not.
    (
        "a_terminal_event_only_cuts",
        Recipe(
            method="kahan_li8",
            bodies=8,
            massless=5,
            forces=(("Gravity", 94),),
            seed=1291,
            tame=False,
            planar=True,
            at_origin=True,
            drifting=True,
            offset=3,
            members=8,
            own=("velocity", "parameters", "position", "mass"),
            steps=26,
            transformation="distance",
            outputs=6,
            columns=("center_of_mass",),
            events=(("distance", 19), ("plane", 66)),
            backward=True,
        ),
    ),
    # An event stopped a run in a state in which another body was no number any more.
    (
        "a_terminal_event_only_cuts",
        Recipe(
            method="heun",
            bodies=25,
            forces=(("Drag", 48), ("Gravity", 31), ("Gravity", 83)),
            seed=587,
            tame=False,
            drifting=True,
            wild_member=True,
            steps=5,
            ragged=True,
            decades=6,
            outputs=4,
            collisions="stop",
            t0=1.9655928963165258e-134,
            backward=True,
        ),
    ),
    # Bodies that fail, and for the events fail together, a little earlier: the law took their last states for the same.
    (
        "events_change_no_bit_of_the_run",
        Recipe(
            method="verner98",
            bodies=5,
            forces=(("DrivenForce", 70), ("LinearDrag", 4), ("Drag", 34)),
            seed=46458,
            tame=False,
            planar=True,
            units=(-258, 153, -210),
            steps=22,
            decades=7,
            outputs=4,
            columns=("energy",),
            backward=True,
        ),
    ),
    # The law took a body at rest for exact, which is integrated about an origin that moves.
    (
        "a_located_event_is_a_zero_at_its_state",
        Recipe(
            method="sofroniou_spaletta10",
            bodies=3,
            forces=(("Spring", 39), ("Spring", 39)),
            seed=7907,
            at_origin=True,
            steps=1,
            collisions="stop",
        ),
    ),
    # A body without events that left the law of its drag inside a step was charged with all of it, if another body in
    # its lanes had events.
    (
        "a_member_is_as_if_alone",
        Recipe(
            method="rk4",
            bodies=3,
            forces=(("Drag", 7), ("Drag", 30)),
            seed=273,
            tame=False,
            drifting=True,
            own=("numbers",),
            steps=14,
            decades=10,
            outputs=3,
            columns=("energy", "velocity", "momentum"),
            events=(("apsis", 26),),
            backward=True,
        ),
    ),
    # One and the same distance looked for twice, of which the first ends the run: both are in the table at that time.
    (
        "a_terminal_event_only_cuts",
        Recipe(
            method="sofroniou_spaletta10",
            bodies=11,
            forces=(("DrivenForce", 28), ("DrivenForce", 62)),
            seed=1,
            tame=False,
            members=11,
            own=("mass", "numbers", "velocity", "position", "parameters"),
            steps=24,
            decades=6,
            outputs=3,
            columns=("momentum", "position"),
            events=(("distance", 83), ("plane", 78), ("distance", 83)),
        ),
    ),
    # Two that a spring holds merge, and the others, on which nothing acts any more, go on in a closed form.
    *(
        (
            law,
            Recipe(
                method="auto",
                bodies=9,
                forces=(("Spring", 67),),
                seed=916,
                tame=False,
                planar=True,
                at_origin=True,
                members=9,
                own=("parameters",),
                steps=2,
                outputs=5,
                columns=("position",),
                collisions="merge",
            ),
        )
        for law in ("events_change_no_bit_of_the_run", "no_step_is_longer_than_max_step")
    ),
    # Two zeros of one event in the step that another ends, both told at its end: one is ahead.
    (
        "a_terminal_event_only_cuts",
        Recipe(
            method="auto",
            bodies=8,
            forces=(("PostNewtonian", 63),),
            seed=65535,
            at_origin=True,
            drifting=True,
            members=5,
            own=("mass",),
            steps=1,
            backward=True,
            events=(("energy", 41), ("energy", 84), ("energy", 41)),
        ),
    ),
]
