"""Scenes of bodies that turn which failed a law on the way, with what was wrong."""

from __future__ import annotations

from rigid_recipe import RigidRecipe

KEPT_RIGID: list[tuple[str, RigidRecipe]] = []
