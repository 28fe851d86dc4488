"""The shipped instruments, and small ones made for a test."""

from dataclasses import replace
from pathlib import Path

from app.protocol import load_instrument
from app.science.instruments import Instrument, Item, Provenance, Scale, Score

CONFIGS = Path(__file__).parents[3] / "study_configs" / "instruments"


def shipped(key: str) -> Instrument:
    """Return a shipped instrument by its key."""
    return load_instrument((CONFIGS / f"{key}.yaml").read_text(encoding="utf-8")).instrument


_SMALL = Instrument(
    key="small",
    version=1,
    title={"en": "Small"},
    languages=("en",),
    items=(
        Item("q1", {"en": "One"}, "likert"),
        Item("q2", {"en": "Two"}, "likert"),
        Item("size", {"en": "Size"}, "number", required=False, minimum=0, unit="cm"),
        Item("yes", {"en": "Yes?"}, "boolean", required=False),
        Item("note", {"en": "Note"}, "text", required=False, max_length=5),
    ),
    provenance=Provenance("made for a test", "none", "nothing"),
    scale=Scale(1, 7, ()),
    scores=(Score("both", {"en": "Both"}, "q1 + q2"), Score("half", {"en": "Half"}, "both / 2")),
)


def small(**changes: object) -> Instrument:
    """Return a small instrument with some fields changed."""
    return replace(_SMALL, **changes)  # type: ignore[arg-type]  # any field
