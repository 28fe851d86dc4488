"""Show an operator which changes to the avatar are in force, and which are possible."""

from pydantic import BaseModel
from sqlalchemy.orm import Session

from app.errors import Conflict
from app.features.movement.avatar import configuration_by_hash
from app.features.record.cockpit.schemas import AvatarChangesView
from app.features.record.sessions import avatar_in_force
from app.models import StudySession
from app.protocol import MAX_FACTOR, driven_axes_of
from app.science.avatar.body import SWITCHABLE_LAYERS
from app.science.avatar.configuration import GROUP_NAMES, ColliderKind, as_configured, degrees_of


class LayerChoice(BaseModel):
    """A pair of collision layers that can be switched, and whether it collides by default."""

    layers: tuple[str, str]
    collide: bool


class AxisChoice(BaseModel):
    """An axis that a cast can hold, at an angle within these limits."""

    axis: str
    low_deg: float
    high_deg: float


class AvatarChoices(BaseModel):
    """Everything that can be changed about a session's avatar while it runs.

    `gravity` and `self_collision` are as configured. `groups`: body groups and parts that colliders
    can be chosen for; `driven`: those of them that a cast can hold and whose motors can be changed.
    """

    gravity: bool
    self_collision: bool
    groups: list[str]
    driven: list[str]
    kinds: list[ColliderKind]
    layers: list[LayerChoice]
    axes: list[AxisChoice]
    greatest_factor: float


def avatar_choices(db: Session, session: StudySession) -> AvatarChoices:
    """Return what can be changed; raises Conflict if the session has no physics avatar."""
    if session.avatar_configuration_hash is None:
        raise Conflict(
            "the avatar of this session is not moved by physics",
            value=session.avatar,
            remedy="Use a version of the study with avatar: physics.",
        )
    configuration = configuration_by_hash(db, session.avatar_configuration_hash)
    settings = as_configured(configuration)
    pairs = sorted(sorted(pair) for pair in SWITCHABLE_LAYERS)
    return AvatarChoices(
        gravity=settings.gravity,
        self_collision=settings.self_collision,
        groups=list(GROUP_NAMES),
        driven=[name for name in GROUP_NAMES if driven_axes_of(configuration, name)],
        kinds=["simple", "mesh", "none"] if configuration.uses_pieces else ["simple", "none"],
        layers=[
            LayerChoice(layers=(a, b), collide=frozenset((a, b)) in settings.layers)
            for a, b in pairs
        ],
        axes=[
            AxisChoice(
                axis=name, low_deg=degrees_of(one.low_rad), high_deg=degrees_of(one.high_rad)
            )
            for name, one in settings.axes.items()
        ],
        greatest_factor=MAX_FACTOR,
    )


def avatar_changes_view(
    db: Session, session: StudySession, *, blinded: bool
) -> AvatarChangesView | None:
    """Return the changes in force; None if nothing was ever changed, or the session has ended.

    `blinded` readers do not get the headset's own words, which may name the body that is worn.
    """
    in_force = avatar_in_force(db, session)
    if in_force is None:
        return None
    report, settings = in_force.report, in_force.settings
    return AvatarChangesView(
        revision=in_force.revision,
        study=in_force.study,
        operator=in_force.operator,
        applied=None if report is None else report.applied,
        problem=None if report is None or blinded else report.problem,
        gravity=settings.gravity,
        self_collision=settings.self_collision,
        held_parts=list(settings.held_parts),
        passing_parts=list(settings.passing_parts),
    )
