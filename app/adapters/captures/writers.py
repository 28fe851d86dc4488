"""The registry of the formats in which movement can be written, the usual one first.

A writer is one object: its key in addresses, how its files end, their media type, what people call
it, and the function that writes. Whoever adds one writes that function and its entry in `WRITERS`;
the download of a capture on an avatar, `reembody retarget --out` and the buttons of the page follow
from that.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass

from app.adapters.captures.bvh_export import to_bvh
from app.adapters.captures.table_export import to_csv
from app.science.rig import RigMotion
from app.texts import Words


@dataclass(frozen=True)
class MovementWriter:
    """A format in which a skeleton's movement can be written, as text in UTF-8.

    Attributes:
        key: in addresses, and the ending of the files.
        media_type: of the files.
        name: as buttons show it.
        write: yields the text in pieces.
    """

    key: str
    media_type: str
    name: Words
    write: Callable[[RigMotion], Iterable[str]]

    @property
    def suffix(self) -> str:
        """How the files end, with the point."""
        return f".{self.key}"


WRITERS: tuple[MovementWriter, ...] = (
    MovementWriter(
        key="bvh",
        media_type="text/plain",
        name=Words(en="BVH", de="BVH"),
        write=lambda motion: (to_bvh(motion),),
    ),
    MovementWriter(
        key="csv",
        media_type="text/csv",
        name=Words(en="CSV", de="CSV"),
        write=to_csv,
    ),
)


def writer_of(key: str) -> MovementWriter:
    """The writer with this key; raises KeyError where there is none."""
    return {one.key: one for one in WRITERS}[key]


def writer_texts() -> dict[str, Words]:
    """The names of the formats, by their keys in the tables of the pages."""
    return {f"movement.format.{one.key}": one.name for one in WRITERS}
