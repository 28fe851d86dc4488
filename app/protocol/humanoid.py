"""Store the measures of a humanoid model as JSON: the same model gives the same bytes."""

from typing import Annotated, Literal

from pydantic import Field, TypeAdapter

from app.protocol.common import Strict, canonical_json
from app.science.avatar.body import PART_NAMES, Figure, Piece
from app.science.rotations import Vector


class PieceFile(Strict):
    """A convex piece of a body part.

    The file contains its corners in the part's frame, and how far the skin protrudes from it.
    """

    corners_m: list[Vector]
    outside_m: Annotated[float, Field(ge=0)]


class FigureFile(Strict):
    """A model's measures; see `app.science.avatar.body.figure.Figure`."""

    format: Literal["reembody-humanoid"]
    version: Literal[1]
    stature_m: Annotated[float, Field(gt=0)]
    places_m: dict[str, Vector]
    segments_m: dict[str, float]
    pieces: dict[str, PieceFile]
    notes: list[str]


_ADAPTER = TypeAdapter(FigureFile)


def figure_json(figure: Figure) -> str:
    """Format a model's measures as canonical JSON."""
    file = FigureFile(
        format="reembody-humanoid",
        version=1,
        stature_m=figure.stature_m,
        places_m=dict(figure.places_m),
        segments_m=dict(figure.segments_m),
        pieces={
            part: PieceFile(corners_m=list(piece.corners_m), outside_m=piece.outside_m)
            for part, piece in figure.pieces.items()
        },
        notes=list(figure.notes),
    )
    return canonical_json(file.model_dump(mode="json"))


def parse_figure(text: str) -> Figure:
    """Parse the measures of a humanoid model from their stored JSON."""
    file = _ADAPTER.validate_json(text)
    return Figure(
        file.stature_m,
        {part: file.places_m[part] for part in PART_NAMES if part in file.places_m},
        dict(file.segments_m),
        {
            part: Piece(tuple(file.pieces[part].corners_m), file.pieces[part].outside_m)
            for part in PART_NAMES
            if part in file.pieces
        },
        tuple(file.notes),
    )
