"""The hand and foot box tasks: place, contacts, rules and summaries."""

from app.science.tasks.layout import (
    BlockSpec,
    BoxSpec,
    Direction,
    Laterality,
    LayoutError,
    Limb,
    Side,
    Surface,
    SurfaceKind,
    TaskLayout,
    build_layout,
)

__all__ = [
    "BlockSpec",
    "BoxSpec",
    "Direction",
    "Laterality",
    "LayoutError",
    "Limb",
    "Side",
    "Surface",
    "SurfaceKind",
    "TaskLayout",
    "build_layout",
]
