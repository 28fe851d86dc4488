"""Compare two versions of an avatar configuration for the interface."""

from sqlalchemy.orm import Session

from app.features.movement.avatar.editing import change_views
from app.features.movement.avatar.schemas import AvatarVersionDifference, GroupDifference
from app.features.movement.avatar.service import avatar_by_key, typed, version_of
from app.features.movement.avatar.views import version_view
from app.protocol.avatar_editing import differences, sums_by_group


def version_difference(db: Session, key: str, old: int, new: int) -> AvatarVersionDifference:
    """Return how two versions of an avatar differ; raise NotFound."""
    avatar = avatar_by_key(db, key)
    before, after = version_of(db, key, old), version_of(db, key, new)
    changes = differences(typed(before), typed(after))
    return AvatarVersionDifference(
        key=key,
        title=avatar.title,
        old=version_view(before),
        new=version_view(after),
        same=not changes,
        changed=change_views(changes),
        groups=[
            GroupDifference(group=group, parts=list(parts), values=values)
            for group, (parts, values) in sums_by_group(changes).items()
        ],
    )
