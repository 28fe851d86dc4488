"""A finding about a captured body that anatomy does not allow, and what was done about it."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal

Rule = Literal[
    "mirrored", "pelvis", "sides", "length", "toes", "step_height", "unit", "upright", "knees",
    "frozen", "jump",
]  # fmt: skip
"""The rule that a body breaks: left and right are mirrored; it is upside down or lies; hip centres
lie above the pelvis or its markers contradict those of the legs; two sides differ; a length does
not fit the others; toes are missing; step heights do not scale with the legs; a knee bends
backwards or never; frames repeat exactly; the body or a marker jumps. Or a file's unit of length is
only known from the size of the body, `unit`."""


@dataclass(frozen=True)
class Notice:
    """One finding.

    Attributes:
        rule: the rule that is broken.
        action: `mended` if the result was corrected, `refused` if there is none, `noted` if the
            result is as captured and its user has to judge.
        what: what was found and what was done, a sentence.
        value: the measured value, with its unit.
        valid: the values that are expected.
        remedy: what the user can do, a sentence.
    """

    rule: Rule
    action: Literal["mended", "refused", "noted"]
    what: str
    value: str
    valid: str
    remedy: str

    @property
    def sentence(self) -> str:
        """Return everything as text: what, value, what is valid, what to do."""
        return f"{self.what} Found: {self.value}; expected: {self.valid}. {self.remedy}"


def sentences(notices: Iterable[Notice]) -> tuple[str, ...]:
    """Return each notice as text."""
    return tuple(notice.sentence for notice in notices)


def backward_foot_notice(side: str, turned: str) -> Notice:
    """Return the refusal of a body of which one foot points backwards.

    Args:
        side: left or right.
        turned: the angle between that foot and the body's front, with its unit.
    """
    return Notice(
        "mirrored",
        "refused",
        f"The {side} foot points backwards, the other one forwards.",
        f"its toes point {turned} away from the body's front",
        "less than 90 degrees",
        f"Exchange the labels of heel and toes of the {side} foot.",
    )


def mirrored_notice(value: str, valid: str) -> Notice:
    """Return the notice on a capture whose left and right were mirrored back."""
    return Notice(
        "mirrored",
        "mended",
        "Left and right are mirrored, as from left-handed axes: x was negated.",
        value,
        valid,
        "If instead all names of left and right were exchanged, exchange them and export again: the"
        " movement shown is then the mirror image of the person's.",
    )
