"""Humanoid models that give avatars their shape: uploaded, measured and identified by hash."""

from app.features.movement.humanoids.service import (
    figure_by_hash,
    humanoid_by_hash,
    is_known,
    parsed_figure,
)

__all__ = ["figure_by_hash", "humanoid_by_hash", "is_known", "parsed_figure"]
