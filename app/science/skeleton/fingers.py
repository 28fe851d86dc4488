"""Define the 30 finger parts and their order, which streams of fingers use.

Names are those of Unity's HumanBodyBones: for each hand, first the left, five fingers from the
thumb to the little one, each from the knuckle to the tip. A part's rotation is parent_from_part,
relative to the T-pose, in which all fingers lie flat; its parent is the hand or the part before it.
"""

FINGERS = ("Thumb", "Index", "Middle", "Ring", "Little")
SEGMENTS = ("Proximal", "Intermediate", "Distal")
FINGER_PARTS: tuple[str, ...] = tuple(
    f"{side}{finger}{segment}"
    for side in ("Left", "Right")
    for finger in FINGERS
    for segment in SEGMENTS
)
FINGER_COUNT = len(FINGER_PARTS)
PARTS_PER_HAND = FINGER_COUNT // 2


def finger_of(part: str) -> str | None:
    """Return the finger that a part belongs to, such as "Thumb"; None for any other part."""
    return next((finger for finger in FINGERS if finger in part), None)
