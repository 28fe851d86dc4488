"""Check captured bodies against human anatomy: up and down, left and right, lengths, sides."""

from app.science.anatomy.handedness import (
    Handedness,
    handedness_of,
    knees_agreeing,
    mirrored_bodies,
    mirrored_markers,
    mirrored_skeleton,
)
from app.science.anatomy.lengths import (
    PAIRED,
    PUBLISHED,
    length_notices,
    plausible_m,
    segment_lengths,
    sides_agree,
    stature_from,
)
from app.science.anatomy.notice import (
    Notice,
    Rule,
    backward_foot_notice,
    mirrored_notice,
    sentences,
)
from app.science.anatomy.over_time import (
    distance_notice,
    frozen_notice,
    jump_notice,
    repeated,
)
from app.science.anatomy.uprightness import (
    tilts_deg,
    turned_over_bodies,
    turned_over_markers,
    turned_over_skeleton,
    upright_notice,
)

__all__ = [
    "PAIRED",
    "PUBLISHED",
    "Handedness",
    "Notice",
    "Rule",
    "backward_foot_notice",
    "distance_notice",
    "frozen_notice",
    "handedness_of",
    "jump_notice",
    "knees_agreeing",
    "length_notices",
    "mirrored_bodies",
    "mirrored_markers",
    "mirrored_notice",
    "mirrored_skeleton",
    "plausible_m",
    "repeated",
    "segment_lengths",
    "sentences",
    "sides_agree",
    "stature_from",
    "tilts_deg",
    "turned_over_bodies",
    "turned_over_markers",
    "turned_over_skeleton",
    "upright_notice",
]
