"""Run `reembody figure`: make a body and write it to a file."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from app.adapters.humanoids.writer import write_mannequin
from app.science.avatar.body import Population, proportions
from app.science.avatar.mannequin import make_mannequin
from app.whole_files import write_whole

POPULATIONS: Mapping[str, Population] = {"male": "male", "female": "female", "neutral": "average"}
"""The populations that the command accepts, and the population whose form each has."""


def make(out: Path, population: str, stature_m: float, segments: Sequence[str]) -> str:
    """Write the body to a file and return a sentence about it.

    Raises ValueError for a stature or a length that no person has, OSError if the file cannot be
    written.
    """
    body = proportions(stature_m, dict(_length(text) for text in segments))
    made = make_mannequin(body, POPULATIONS[population])
    data = write_mannequin(made, population)
    write_whole(out, data)
    return (
        f"{out}: {population}, {stature_m:g} m, {len(made.triangles)} triangles,"
        f" {len(data) / 1000:.0f} kB"
    )


def _length(text: str) -> tuple[str, float]:
    name, _, length = text.partition("=")
    try:
        return name.strip(), float(length)
    except ValueError:
        raise ValueError(
            f"--segment {text!r}: give a name and a length in metres, as in thigh=0.41"
        ) from None
