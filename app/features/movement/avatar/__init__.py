"""Configurations of avatars: named, versioned, imported and exported.

Each content is a version that is never edited; sessions refer to it by its hash.
"""

from app.features.movement.avatar.schemas import (
    MAX_VERSION,
    AvatarKey,
    AvatarTitle,
    AvatarView,
    NewAvatar,
    NewAvatarVersion,
    Note,
)
from app.features.movement.avatar.service import (
    SHIPPED,
    add_avatar_version,
    add_shipped_avatar,
    all_versions,
    avatar_by_key,
    checked,
    configuration_by_hash,
    configurations,
    create_avatar,
    faulty_avatars,
    newest_numbers,
    newest_version,
    typed,
    version_of,
)
from app.features.movement.avatar.views import avatar_view

__all__ = [
    "MAX_VERSION",
    "SHIPPED",
    "AvatarKey",
    "AvatarTitle",
    "AvatarView",
    "NewAvatar",
    "NewAvatarVersion",
    "Note",
    "add_avatar_version",
    "add_shipped_avatar",
    "all_versions",
    "avatar_by_key",
    "avatar_view",
    "checked",
    "configuration_by_hash",
    "configurations",
    "create_avatar",
    "faulty_avatars",
    "newest_numbers",
    "newest_version",
    "typed",
    "version_of",
]
