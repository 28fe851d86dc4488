"""The registry of the capture formats that can be read, in the order in which pages list them.

A format is one object: its name, its file extensions, how its content is recognised, and its reader
function. To add one, write its reader and its entry in `FORMATS`; reading, uploading, the list of
formats and its texts in both languages follow from that.
"""

from collections.abc import Callable
from dataclasses import dataclass
from importlib import import_module
from pathlib import PurePosixPath
from typing import Protocol, cast

from app.adapters.captures.capture import Capture, Limits, Reading
from app.adapters.captures.sniffing import Head
from app.texts import Words


class Reader(Protocol):
    """A function that reads a file of one format, and raises CaptureError."""

    def __call__(self, data: bytes, *, name: str, reading: Reading, limits: Limits) -> Capture:
        """Read a file, as described for `app.adapters.captures.read_capture`."""


@dataclass(frozen=True)
class CaptureFormat:
    """A format that can be read.

    Attributes:
        key: stored with each capture, so it is never renamed.
        title: the full name of the format, for messages.
        extensions: the extensions of its files, in lower case. If no other format has an extension,
            it identifies the format of a file that is not recognised by its content.
        recognises: whether the beginning of a file is of this format.
        reader: "module.function" below `app.adapters.captures`, which is imported when a file of
            this format is read: a server starts without it.
        name: the name shown in lists.
        source: the content of such files, and the programs that write them.
    """

    key: str
    title: str
    extensions: tuple[str, ...]
    recognises: Callable[[Head], bool]
    reader: str
    name: Words
    source: Words

    def load_reader(self) -> Reader:
        """Import and return the function that reads this format."""
        module, _, function = self.reader.rpartition(".")
        return cast("Reader", getattr(import_module(f"app.adapters.captures.{module}"), function))


def _is_acclaim(head: Head) -> bool:
    """Return whether a file is an ASF or AMC.

    These begin with comments and sections such as :version or :DEGREES.
    """
    sections = (":version", ":name", ":units", ":documentation", ":root", ":fully-", ":degrees")
    return head.first_without("#").lower().startswith(sections)


def _is_c3d(head: Head) -> bool:
    """Return whether a file is a C3D, which begins with a block number, then "P".

    A number that is a white-space character does not count: a text may begin with a space and a
    "P".
    """
    data = head.data
    return len(data) > 2 and data[1] == 0x50 and data[0] < 0x20 and data[0] not in b"\t\n\r"


def _is_vicon_tracker(head: Head) -> bool:
    cells = head.cells()
    return cells[0] == "objects" and not any(cells[1:])


def _is_quest_log(head: Head) -> bool:
    return head.has_columns(lambda columns: {"headposx", "headorientationw"} <= set(columns))


def _is_uxf_tracker(head: Head) -> bool:
    # Gaze trackers are included, so that the reader's error can list the columns it needs.
    tracked = ("pos_x", "rot_x", "dir_x", "gaze_x")
    return not _is_quest_log(head) and head.has_columns(
        lambda columns: columns[0] == "time" and any(one.endswith(tracked) for one in columns)
    )


FORMATS: tuple[CaptureFormat, ...] = (
    CaptureFormat(
        key="bvh",
        title="BVH (Biovision Hierarchy)",
        extensions=(".bvh",),
        recognises=lambda head: head.word == "hierarchy",
        reader="bvh_capture.read_bvh_capture",
        name=Words(en="BVH", de="BVH"),
        source=Words(
            en="Skeleton. Exported by Motive, MVN, Rokoko Studio, Blender, MotionBuilder.",
            de="Skelett. Exportiert aus Motive, MVN, Rokoko Studio, Blender, MotionBuilder.",
        ),
    ),
    CaptureFormat(
        key="motive-csv",
        title="OptiTrack Motive CSV",
        extensions=(".csv",),
        recognises=lambda head: head.cells()[0] == "format version",
        reader="motive.read_motive",
        name=Words(en="Motive CSV", de="Motive CSV"),
        source=Words(
            en="Skeleton, rigid bodies or markers. OptiTrack Motive: File, Export Tracking Data.",
            de="Skelett, Starrkörper oder Marker. OptiTrack Motive: File, Export Tracking Data.",
        ),
    ),
    CaptureFormat(
        key="asf-amc",
        title="Acclaim ASF and AMC",
        extensions=(".amc", ".asf"),
        recognises=_is_acclaim,
        reader="asf_amc.read_asf_amc",
        name=Words(en="AMC and ASF", de="AMC und ASF"),
        source=Words(
            en="Skeleton. Two files, as in the CMU motion capture database.",
            de="Skelett. Zwei Dateien, wie in der Bewegungsdatenbank der CMU.",
        ),
    ),
    CaptureFormat(
        key="c3d",
        title="C3D markers",
        extensions=(".c3d",),
        recognises=_is_c3d,
        reader="c3d.read_c3d",
        name=Words(en="C3D", de="C3D"),
        source=Words(
            en="Markers. Vicon Nexus, Qualisys, Motive.",
            de="Marker. Vicon Nexus, Qualisys, Motive.",
        ),
    ),
    CaptureFormat(
        key="trc",
        title="TRC markers",
        extensions=(".trc",),
        recognises=lambda head: head.word == "pathfiletype",
        reader="trc.read_trc",
        name=Words(en="TRC", de="TRC"),
        source=Words(
            en="Markers. OpenSim, Motion Analysis Cortex.",
            de="Marker. OpenSim, Motion Analysis Cortex.",
        ),
    ),
    CaptureFormat(
        key="vicon-tracker-csv",
        title="Vicon Tracker CSV",
        extensions=(".csv",),
        recognises=_is_vicon_tracker,
        reader="vicon_tracker.read_vicon_tracker",
        name=Words(en="Vicon Tracker CSV", de="Vicon Tracker CSV"),
        source=Words(
            en="Rigid bodies. Vicon Tracker: export as CSV.",
            de="Starrkörper. Vicon Tracker: als CSV exportieren.",
        ),
    ),
    CaptureFormat(
        key="uxf-tracker",
        title="UXF tracker CSV (Unity)",
        extensions=(".csv",),
        recognises=_is_uxf_tracker,
        reader="uxf_tracker.read_uxf_tracker",
        name=Words(en="UXF tracker CSV", de="UXF-Tracker-CSV"),
        source=Words(
            en="One tracker. Written by the Unity Experiment Framework.",
            de="Ein Tracker. Geschrieben vom Unity Experiment Framework.",
        ),
    ),
    CaptureFormat(
        key="quest-log",
        title="Quest movement log",
        extensions=(".csv",),
        recognises=_is_quest_log,
        reader="quest_log.read_quest_log",
        name=Words(en="Quest log", de="Quest-Log"),
        source=Words(
            en="Headset and hands. Movement logs of Quest applications.",
            de="Headset und Hände. Bewegungsprotokolle von Quest-Anwendungen.",
        ),
    ),
)


def format_of(data: bytes, name: str) -> CaptureFormat | None:
    """Determine the format of a file by its content, or else by an unambiguous extension.

    Returns None if neither identifies it.
    """
    head = Head.of(data)
    by_content = next((one for one in FORMATS if one.recognises(head)), None)
    if by_content is not None:
        return by_content
    extension = PurePosixPath(name.lower()).suffix
    by_extension = [one for one in FORMATS if extension in one.extensions]
    return by_extension[0] if len(by_extension) == 1 else None


def extensions() -> tuple[str, ...]:
    """Return the extensions of capture files, each once, in the order of the formats."""
    return tuple(dict.fromkeys(end for one in FORMATS for end in one.extensions))


def format_texts() -> dict[str, Words]:
    """Return the texts of every format, by their keys in the pages' tables."""
    names = {f"format.{one.key}": one.name for one in FORMATS}
    return names | {f"format.{one.key}.from": one.source for one in FORMATS}
