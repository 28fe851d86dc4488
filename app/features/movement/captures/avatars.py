"""In the process for captures: a capture's movement on a reference avatar."""

from dataclasses import dataclass

from app.features.movement.captures.opening import Store, open_stored
from app.features.movement.captures.source import Cannot, Source
from app.science.retargeting import (
    REFERENCE_JOINT_MAP,
    AvatarError,
    Retargeted,
    named_avatar,
    retarget_motion,
)
from app.science.rig import RigError, RigMotion

MapPairs = tuple[tuple[str, str], ...]
"""A joint map that can be part of a key."""


@dataclass(frozen=True)
class Mapped:
    """A stored capture, how it is read, and the map of its joints."""

    store: Store
    source: Source
    joint_map: MapPairs

    @property
    def moving(self) -> RigMotion:
        """The skeleton's movement; raises Cannot."""
        return open_stored(self.store, self.source).moving


def on_avatar(mapped: Mapped, avatar: str, *, lock_feet: bool) -> Retargeted:
    """The movement on the avatar of a stature, such as "165cm"; raises Cannot."""
    try:
        return retarget_motion(
            mapped.moving,
            dict(mapped.joint_map),
            named_avatar(avatar),
            REFERENCE_JOINT_MAP,
            lock=lock_feet,
        )
    except (RigError, AvatarError) as error:
        raise Cannot(str(error)) from None
