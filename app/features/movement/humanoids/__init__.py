"""Bodies: humanoid models that give avatars their shape, identified by hash and named by people."""

from app.features.movement.humanoids.licences import asked_terms
from app.features.movement.humanoids.service import (
    body_by_name,
    figure_by_hash,
    humanoid_by_hash,
    is_known,
    named_bodies,
    parsed_figure,
)
from app.features.movement.humanoids.shipped import add_shipped_bodies

__all__ = [
    "add_shipped_bodies",
    "asked_terms",
    "body_by_name",
    "figure_by_hash",
    "humanoid_by_hash",
    "is_known",
    "named_bodies",
    "parsed_figure",
]
