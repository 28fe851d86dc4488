"""Configurations of avatars: named, versioned, imported and exported.

Each content is a version that is never edited; sessions refer to it by its hash.
"""

from app.features.movement.avatar.schemas import AvatarKey, NewAvatar, NewAvatarVersion
from app.features.movement.avatar.service import (
    SHIPPED,
    add_avatar_version,
    add_shipped_avatar,
    avatar_by_key,
    configuration_by_hash,
    configurations,
    create_avatar,
    newest_numbers,
    newest_version,
    typed,
    version_of,
)

__all__ = [
    "SHIPPED",
    "AvatarKey",
    "NewAvatar",
    "NewAvatarVersion",
    "add_avatar_version",
    "add_shipped_avatar",
    "avatar_by_key",
    "configuration_by_hash",
    "configurations",
    "create_avatar",
    "newest_numbers",
    "newest_version",
    "typed",
    "version_of",
]
