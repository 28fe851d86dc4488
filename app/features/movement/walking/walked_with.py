"""What the walks of a set were walked with: their scenes, and further numbers such as a load.

When a fit is ordered, the scenes are kept with the hash of their files, so that a fit that is
stopped and resumed goes on with the same floors or is refused.
"""

from collections.abc import Sequence

from sqlalchemy.orm import Session

from app.errors import Conflict, InvalidInput
from app.features.movement.walking.models.schemas import WalkedScene
from app.features.movement.walking.scenes import scene_view
from app.features.movement.walking.schemas import WalkSetView
from app.features.movement.walking.set_sources import walked_scene_text
from app.science.walking.records import LEAST_KNOWN, OPEN_FLOOR


def walked_scenes(db: Session, walks: WalkSetView) -> list[WalkedScene]:
    """Return the scenes of a set as they are now; raise Conflict if one was deleted."""
    found = []
    for one in walks.summary.scenes:
        if one.key is None or one.key == OPEN_FLOOR:
            title = one.key or ""
            found.append(WalkedScene(key=one.key, title=title, content_hash=None, walks=one.walks))
            continue
        walked_scene_text(db, one.key)
        scene = scene_view(db, one.key)
        found.append(
            WalkedScene(
                key=one.key, title=scene.title, content_hash=scene.content_hash, walks=one.walks
            )
        )
    return found


def check_unchanged(db: Session, scenes: Sequence[WalkedScene]) -> None:
    """Raise Conflict if a scene is not what it was when the fit was ordered."""
    for one in scenes:
        if one.key is None or one.content_hash is None:
            continue
        walked_scene_text(db, one.key)
        if scene_view(db, one.key).content_hash != one.content_hash:
            raise Conflict(
                "a scene of these walks has changed since the fit was ordered",
                value=one.key,
                remedy="Fit a new model.",
            )


def check_numbers(walks: WalkSetView, names: Sequence[str]) -> None:
    """Raise InvalidInput if a model of a set cannot depend on these further numbers."""
    numbers, total = walks.summary.numbers, walks.summary.walks
    usable = {
        name: one
        for name, one in numbers.items()
        if one.walks >= LEAST_KNOWN * total and one.range.low < one.range.high
    }
    for name in names:
        if name in usable:
            continue
        if name not in numbers:
            reason = f"these walks have no number {name!r}"
        elif numbers[name].walks < LEAST_KNOWN * total:
            reason = f"{name} is known for {numbers[name].walks} of {total} walks only"
        else:
            reason = f"{name} is the same for all walks, so nothing can be learnt from it"
        raise InvalidInput(
            reason,
            value=name,
            valid=sorted(usable),
            remedy="Choose one that differs and that at least half of the walks have.",
        )
