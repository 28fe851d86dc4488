"""Read `tests/vectors/tasks`; its README describes the format."""

import json
from pathlib import Path
from typing import Any

from app.science.tasks import (
    BlockSpec,
    BoxSpec,
    Command,
    CommandKind,
    Contact,
    ContactChange,
    Direction,
    Laterality,
    Limb,
    Side,
    TaskLayout,
    build_layout,
)

FOLDER = Path(__file__).parents[2] / "vectors" / "tasks"
Json = dict[str, Any]


def read_all() -> dict[str, Json]:
    """Return every vector by its file name."""
    return {path.stem: json.loads(path.read_text()) for path in sorted(FOLDER.glob("*.json"))}


def of_kind(kind: str) -> list[tuple[str, Json]]:
    """Return the vectors of one kind, with their names."""
    return [(name, vector) for name, vector in read_all().items() if vector["kind"] == kind]


def layout(name: str) -> TaskLayout:
    """Return one of the layouts in layouts.json."""
    return build(read_all()["layouts"]["layouts"][name])


def build(spec: Json) -> TaskLayout:
    """Return the layout of a specification."""
    return build_layout(
        Limb(spec["limb"]),
        tuple(
            BoxSpec(box["number"], tuple(box["center_m"]), tuple(box["inner_size_m"]))
            for box in spec["boxes"]
        ),
        _required_block(spec["target"]),
        wall_thickness_m=spec["wall_thickness_m"],
        panel_thickness_m=spec["panel_thickness_m"],
        reverse_after_task=spec["reverse_after_task"],
        start_square=_required_block(spec["start_square"]) if spec["start_square"] else None,
        sides=tuple(Side(side) for side in spec["sides"]),
        counting_foot=Laterality(spec["counting_foot"]) if spec["counting_foot"] else None,
        direction=Direction(spec["direction"]),
    )


def step(entry: Json) -> Command | ContactChange:
    """Return one entry of a rules vector's inputs as a command or a change."""
    if "command" in entry:
        return Command(CommandKind(entry["command"]), entry["time_s"])
    begins = tuple(Contact(*contact) for contact in entry["begins"])
    return ContactChange(entry["time_s"], begins, tuple(Contact(*c) for c in entry["ends"]))


def _required_block(block: Json) -> BlockSpec:
    return BlockSpec(tuple(block["center_m"]), tuple(block["size_m"]))
