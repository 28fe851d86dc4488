"""Bodies: humanoid models that give avatars their shape, identified by hash and named by people."""

from app.features.movement.humanoids.licences import asked_terms, licence_is_read
from app.features.movement.humanoids.schemas import BindingView
from app.features.movement.humanoids.service import (
    body_by_name,
    figure_by_hash,
    humanoid_by_hash,
    is_known,
    named_bodies,
    parsed_figure,
)
from app.features.movement.humanoids.shipped import SHIPPED_BODIES, add_shipped_bodies
from app.features.movement.humanoids.uploading import stored_binding
from app.features.movement.humanoids.worker_tasks import Refused, measure

__all__ = [
    "SHIPPED_BODIES",
    "BindingView",
    "Refused",
    "add_shipped_bodies",
    "asked_terms",
    "body_by_name",
    "figure_by_hash",
    "humanoid_by_hash",
    "is_known",
    "licence_is_read",
    "measure",
    "named_bodies",
    "parsed_figure",
    "stored_binding",
]
