"""Laws that need no reference, all of them: they are asked where features meet.

Each law is a function of a recipe that raises `AssertionError`, or `Refused` when the scene or the request is refused
(by name, before anything runs: `refusals_are_made_by_the_plan_and_by_the_run` looks at that alone).
"""

import accuracy_laws
import bit_laws
import event_laws
import motion_laws
import symmetry_laws
import work_laws
from law_book import LAWS

__all__ = ["LAWS", "accuracy_laws", "bit_laws", "event_laws", "motion_laws", "symmetry_laws", "work_laws"]
