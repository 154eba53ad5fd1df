"""Scenes of bodies that turn which failed a law on the way, with what was wrong."""

from __future__ import annotations

from rigid_recipe import RigidRecipe

KEPT_RIGID: list[tuple[str, RigidRecipe]] = [
    # Bodies that nothing turns began anew in each leg, with other roundings.
    (
        "a_run_goes_on_with_the_bits_of_the_whole",
        RigidRecipe(method="mclachlan4", bodies=2, rigid=2, seed=815, steps=16, shape="tilted", loads=(), outputs=2),
    ),
    (
        "a_run_goes_on_with_the_bits_of_the_whole",
        RigidRecipe(method="leapfrog", bodies=2, seed=7, steps=16, members=5, shape="tilted", loads=(), outputs=3),
    ),
    # A quaternion that large turns had left four units from length 1 was taken for another.
    *(
        (
            "a_run_goes_on_with_the_bits_of_the_whole",
            RigidRecipe(
                method="euler",
                tame=False,
                steps=steps,
                decades=5,
                columns=("position",),
                loads=(("spring to a place", 79),),
                spin=0.0,
            ),
        )
        for steps in (9, 10)
    ),
    # Velocities of held bodies were found anew from their spins, with other roundings.
    (
        "final_is_the_last_state",
        RigidRecipe(method="kahan_li8", held=1, seed=23148, loads=(("torque in the body", 38),), spin=10.0),
    ),
    (
        "final_is_the_last_state",
        RigidRecipe(method="midpoint", members=4, held=1, seed=549, loads=(("spring to a place", 96),)),
    ),
]
