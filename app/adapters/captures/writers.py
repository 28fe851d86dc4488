"""The registry of the formats in which movement can be written, the default first.

A writer is one object: its key in addresses, its file extension, its media type, its name, and the
function that writes. To add one, write that function and its entry in `WRITERS`; the download of a
capture on an avatar, `reembody retarget --out` and the buttons of the page follow from that.
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
        key: used in addresses and as the file extension.
        media_type: the media type of the files.
        name: the name shown on buttons.
        write: yields the text in pieces.
    """

    key: str
    media_type: str
    name: Words
    write: Callable[[RigMotion], Iterable[str]]

    @property
    def suffix(self) -> str:
        """The file extension, with the dot."""
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
    """Return the writer with this key; raise KeyError if there is none."""
    return {one.key: one for one in WRITERS}[key]


def writer_texts() -> dict[str, Words]:
    """Return the names of the formats, by their keys in the pages' tables."""
    return {f"movement.format.{one.key}": one.name for one in WRITERS}
