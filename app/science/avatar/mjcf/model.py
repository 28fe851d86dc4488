"""From a configuration and a stature to the model that is simulated, here and in the browser.

The same configuration and stature give the same text to the byte, so its hash names the model, and
a model need not be kept to be had again.
"""

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass

from app.science.avatar.body import (
    AXES_OF,
    PART_NAMES,
    Body,
    BodyError,
    BodyMasses,
    Figure,
    body_masses,
    build_body,
)
from app.science.avatar.configuration import (
    DEFAULT_OPTIONS,
    Colliders,
    Configuration,
    ModelOptions,
    piece_problems,
)
from app.science.avatar.mjcf.mjcf import build_mjcf
from app.science.avatar.mjcf.scene import FLOOR_ONLY, Scene


@dataclass(frozen=True)
class AvatarModel:
    """A body that behaves as a configuration says.

    Attributes:
        configuration: as it was given.
        body: its parts.
        masses: of the parts.
        mjcf: the model as MuJoCo reads it.
    """

    configuration: Configuration
    body: Body
    masses: BodyMasses
    mjcf: str

    @property
    def simple_instead(self) -> tuple[str, ...]:
        """Parts that are to collide with a piece of skin, but have none: they keep their shapes."""
        return tuple(
            name
            for name, part in self.body.parts.items()
            if part.piece is None and self.configuration.collider_of(name) == "mesh"
        )

    @property
    def content_hash(self) -> str:
        """SHA-256 of the text's bytes."""
        return hashlib.sha256(self.mjcf.encode()).hexdigest()


def avatar_model(
    configuration: Configuration,
    stature_m: float,
    *,
    segments_m: Mapping[str, float] | None = None,
    figure: Figure | None = None,
    scene: Scene = FLOOR_ONLY,
    longest_delay_s: float = DEFAULT_OPTIONS.longest_delay_s,
    switchable_colliders: bool = False,
) -> AvatarModel:
    """Build the avatar of a person.

    Args:
        configuration: how it behaves. Locked groups have no hinges in the model.
        stature_m: of the person.
        segments_m: measured lengths, by the names of `proportions.SEGMENT_NAMES`; not of a model.
        figure: the model that the configuration names, as large as it is; parts that it lacks are
            left out.
        scene: what the avatar can collide with.
        longest_delay_s: the most latency that can be set while it runs.
        switchable_colliders: put the figure's pieces beside the simple shapes even where the
            configuration wants none, so that they can be chosen while it runs.

    Raises:
        BodyError: the configuration lacks a part without which there is no body, a length is not
            plausible, or the configuration's model is not given.
    """
    _check_figure(configuration, figure)
    # Parts without driven axes, hips and shoulders, are not named in a configuration.
    driven = set(configuration.parts)
    parts = [part for part in PART_NAMES if part in driven or not AXES_OF[part]]
    body = build_body(stature_m, segments_m=segments_m, parts=parts, figure=figure)
    masses = body_masses(body, configuration.total_mass_kg, population=configuration.population)
    options = ModelOptions(
        hips=configuration.hips,
        gravity=configuration.gravity,
        self_collision=configuration.self_collision,
        longest_delay_s=longest_delay_s,
    )
    colliders = Colliders(
        {part: configuration.collider_of(part) for part in body.parts},
        both=switchable_colliders or configuration.wants_pieces,
    )
    mjcf = build_mjcf(
        body, masses, configuration.in_force, scene=scene, options=options, colliders=colliders
    )
    return AvatarModel(configuration, body, masses, mjcf)


def _check_figure(configuration: Configuration, figure: Figure | None) -> None:
    for problem in piece_problems(configuration):
        raise BodyError(f"{problem.message} {problem.remedy}")
    if (figure is None) != (configuration.humanoid is None):
        raise BodyError(
            "The configuration names no model, so it has its person's body."
            if figure is not None
            else f"The configuration is for the model {configuration.humanoid}, which is not here."
        )
