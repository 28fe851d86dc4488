"""Parse models' files, in the worker process for captures and within its limits."""

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from app.adapters.humanoids import HumanoidFileError, Limits, ReadHumanoid, read_humanoid
from app.features.movement.files import compress, compressed_beside, stored_files
from app.features.movement.humanoids.licences import stored_licence
from app.features.movement.humanoids.schemas import BindingView
from app.protocol.humanoid import figure_json
from app.science.avatar.body import Figure, HumanoidError, figure_of

TURNED_DEG = 5.0
"""Arms that were turned by more than this into the T-pose are mentioned in the notes."""


@dataclass(frozen=True)
class Measured:
    """The measurements of a model's file, as stored in the table `humanoids`."""

    figure: str
    bones_by: str
    stature_m: float
    parts: int
    pieces: int
    left_fingers: int
    right_fingers: int
    licence: dict[str, Any]
    triangles: int
    vertices: int
    textures: int


def measured(figure: Figure, read: ReadHumanoid) -> Measured:
    """Return the measurements of a model and of its figure."""
    return Measured(
        figure=figure_json(figure),
        bones_by=read.bones_by,
        stature_m=figure.stature_m,
        parts=len(figure.places_m),
        pieces=len(figure.pieces),
        left_fingers=figure.finger_count("Left"),
        right_fingers=figure.finger_count("Right"),
        licence=stored_licence(read.rights),
        triangles=read.contents.triangles,
        vertices=read.contents.vertices,
        textures=len(read.contents.textures),
    )


@dataclass(frozen=True)
class Refused:
    """The reason why a file is not a valid model, and the place in the file."""

    reason: str
    place: str


def binding_json(database_url: str, max_bytes: int, content_hash: str) -> bytes:
    """Return a stored model's binding as the JSON of a `BindingView`.

    Its pictures are not checked again: bodies of earlier releases stay readable.
    """
    data = stored_files(database_url, (content_hash,))[content_hash]
    binding = read_humanoid(data, Limits(bytes=max_bytes), check_pictures=False).binding
    view = BindingView(
        stature_m=binding.stature_m,
        parts=list(binding.parts),
        parents=list(binding.parents),
        joints_m=binding.joints_m.tolist(),
        nodes=list(binding.nodes),
        part_from_node=binding.part_from_node.reshape(-1, 16).tolist(),
    )
    return view.model_dump_json().encode()


def measure(max_bytes: int, path: Path) -> Measured | Refused:
    """Parse and measure a newly uploaded file, and write a compressed copy next to it."""
    try:
        read = read_humanoid(path.read_bytes(), Limits(bytes=max_bytes))
        figure = figure_of(read.humanoid)
    except HumanoidFileError as error:
        return Refused(error.reason, error.place)
    except HumanoidError as error:
        return Refused(str(error), "")
    compress(path, compressed_beside(path))
    if read.arms_turned_deg > TURNED_DEG:
        turned = f"The arms were turned by {read.arms_turned_deg:.0f} degrees into the T-pose."
        figure = replace(figure, notes=(*figure.notes, turned))
    return measured(figure, read)
