"""Build the model that is simulated, on the server and in the browser, for a person's stature.

The same configuration and stature give the same text, byte for byte, so its hash identifies the
model, and a model can be rebuilt instead of stored.
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
    carried_parts,
    piece_problems,
)
from app.science.avatar.mjcf.mjcf import build_mjcf
from app.science.avatar.mjcf.scene import FLOOR_ONLY, Scene


@dataclass(frozen=True)
class AvatarModel:
    """The model of an avatar with what it was built from.

    Attributes:
        configuration: the configuration as it was given.
        body: the body with its parts.
        masses: the masses of the parts.
        mjcf: the model as MuJoCo reads it.
    """

    configuration: Configuration
    body: Body
    masses: BodyMasses
    mjcf: str

    @property
    def fallback_parts(self) -> tuple[str, ...]:
        """Return the parts that are configured to collide as meshes but have no convex piece.

        They keep their simple shapes.
        """
        return tuple(
            name
            for name, part in self.body.parts.items()
            if part.piece is None and self.configuration.collider_of(name) == "mesh"
        )

    @property
    def content_hash(self) -> str:
        """Return the SHA-256 of the MJCF text as hexadecimal digits."""
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
    step_s: float = DEFAULT_OPTIONS.step_s,
) -> AvatarModel:
    """Build the avatar of a person.

    Args:
        configuration: gains, limits, masses and colliders. Locked groups have no hinges in the
            model.
        stature_m: the stature of the person.
        segments_m: measured lengths, by the names of `proportions.SEGMENT_NAMES`; not allowed with
            a figure.
        figure: the model that the configuration names, in its own size; parts that it lacks are
            left out.
        scene: the surroundings with which the avatar can collide.
        longest_delay_s: the longest latency that can be set while the model runs.
        switchable_colliders: add the figure's convex pieces next to the simple shapes even where
            the configuration does not use them, so that they can be chosen while the model runs.
        step_s: the time step of the simulation.

    Raises:
        BodyError: the configuration lacks an indispensable part, a length is not plausible, or the
            configuration's model is not given.
    """
    _check_figure(configuration, figure)
    # Hips and shoulders have no driven axes, so a configuration does not name them.
    driven = set(configuration.parts)
    parts = [part for part in PART_NAMES if part in driven or not AXES_OF[part]]
    body = build_body(stature_m, segments_m=segments_m, parts=parts, figure=figure)
    masses = body_masses(
        body,
        configuration.total_mass_kg,
        population=configuration.population,
        relative=configuration.relative_masses,
    )
    options = ModelOptions(
        hips=configuration.hips,
        gravity=configuration.gravity,
        self_collision=configuration.self_collision,
        longest_delay_s=longest_delay_s,
        colliding=configuration.colliding,
        delays_s=configuration.delays_s,
        carried_parts=carried_parts(configuration.compliance),
        step_s=step_s,
    )
    colliders = Colliders(
        {part: configuration.collider_of(part) for part in body.parts},
        both=switchable_colliders or configuration.uses_pieces,
    )
    mjcf = build_mjcf(
        body, masses, configuration.motors, scene=scene, options=options, colliders=colliders
    )
    return AvatarModel(configuration, body, masses, mjcf)


def _check_figure(configuration: Configuration, figure: Figure | None) -> None:
    for problem in piece_problems(configuration):
        raise BodyError(f"{problem.message} {problem.remedy}")
    if (figure is None) != (configuration.humanoid is None):
        raise BodyError(
            "A figure was given, but the configuration names no model: it uses the person's body."
            if figure is not None
            else f"The configuration needs the model {configuration.humanoid}, which was not given."
        )
