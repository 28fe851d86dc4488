"""Make skinned bodies by code, around the 52 parts.

`make_mannequin` makes the skin of a person of any proportions, in the T-pose; the writer of a file
format stores it.
"""

from app.science.avatar.mannequin.mannequin import Mannequin, make_mannequin
from app.science.avatar.mannequin.patchwork import TONES, Tone

__all__ = ["TONES", "Mannequin", "Tone", "make_mannequin"]
