"""Avatar bodies and models built from a made-up humanoid model."""

from dataclasses import replace
from functools import cache

from app.adapters.humanoids import read_humanoid
from app.science.avatar.body.figure import Figure, figure_of
from app.science.avatar.configuration.configuration import Hips
from app.science.avatar.configuration.model_options import ColliderKind
from app.science.avatar.mjcf.gains import default_configuration
from app.science.avatar.mjcf.model import AvatarModel, avatar_model
from app.science.avatar.mjcf.scene import Scene
from tests.support.humanoid_files import humanoid_file
from tests.support.humanoid_model import Model, without

STATURE_M = 1.75
HASH = "0" * 64
"""The hash by which a configuration names the model."""
EMPTY = Scene(floor=False)


@cache
def figure(*lacking: str) -> Figure:
    """Return the made-up model's figure without parts whose names contain one of these words."""
    return figure_of(read_humanoid(humanoid_file(Model(parts=without(*lacking)))).humanoid)


def model(
    colliders: ColliderKind = "simple",
    *,
    own: Figure | None = None,
    scene: Scene = EMPTY,
    hips: Hips = "carried",
    both: bool = False,
    **parts: ColliderKind,
) -> AvatarModel:
    """Return the avatar model of a figure; `parts` gives parts a collider kind of their own."""
    configuration = replace(
        default_configuration(),
        humanoid=HASH,
        colliders=colliders,
        part_colliders=parts,
        hips=hips,
    )
    return avatar_model(
        configuration,
        STATURE_M,
        figure=own or figure(),
        scene=scene,
        switchable_colliders=both,
    )
