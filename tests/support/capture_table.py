"""Generate docs/capture-formats.md: the capture formats, and how every shared file is read.

`python -m tests.support.capture_table > docs/capture-formats.md` rewrites it from the shared data;
a test compares file by file.
"""

import re
import sys
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from app.adapters.captures import FORMATS, Capture, CaptureError, Reading, read_capture
from app.science.fitting import FitError, fit_skeleton
from app.science.rig import MarkerMotion, RigMotion
from tests.support.shared_data import shared_data_folder

REPOSITORY = Path(__file__).resolve().parents[2]
PAGE = REPOSITORY / "docs" / "capture-formats.md"
_FOLDERS = ("motion", "logs")
_LEFT_ASIDE = "motion/natnet/"  # packets of a network protocol, not capture files

_INTRODUCTION = """# Captures: formats and files

A capture is movement recorded with another system. Whatever the format, the result is one of three
things: the movement of a **skeleton** (joints in a tree, a rest pose, a rotation per joint and
frame), of **markers**, or of **rigid bodies**; always in metres, y up, right-handed, quaternions
w, x, y, z. Each result says by which conventions the file was read, and where each comes from:

- *file*: this file says so. *format*: the format always works this way.
- *guessed*: neither does, and the most plausible value was used, such as the unit that makes a
  person one or two metres tall.
- *chosen*: the user said so, which overrides all others. Unit and upward axis can be chosen for
  every file.

Formats are recognised by content, whatever a file is called. A file that breaks its format's rules
is refused with the line and the reason; nothing is repaired silently, each repair is noted.
What a file may occupy is limited (256 MB, 2,000 tracks, 60 million numbers in memory), whatever
its header claims.

## Formats
"""

_FORMATS: Mapping[str, tuple[str, str, str, str]] = {
    "bvh": (
        "skeleton",
        "none in the file: chosen, or guessed from the rest pose",
        "y up",
        "Euler, each joint in its own channel order",
    ),
    "motive-csv": (
        "skeleton, else rigid bodies, else markers",
        "file (m, cm, mm); 1.22 may be silent",
        "y up",
        "quaternion x, y, z, w, or Euler",
    ),
    "asf-amc": (
        "skeleton",
        "file, in CMU's unit of 1/0.45 inch",
        "y up",
        "Euler, each bone's own axes",
    ),
    "c3d": ("markers", "file", "file, else guessed", "none"),
    "trc": ("markers", "file", "guessed", "none"),
    "vicon-tracker-csv": ("rigid bodies", "file", "z up", "rotation vector"),
    "uxf-tracker": ("rigid bodies", "m", "y up, left-handed", "Euler, Unity's order; quaternion"),
    "quest-log": ("rigid bodies", "m", "y up", "quaternion w, x, y, z"),
}

_DETAILS = """
- **BVH.** The unit is guessed among cm, m, mm, 0.056444 m (CMU) and inch. Joints other than the
  root that have their own positions get the median as their bone, with a note of the largest
  deviation. A T-pose row before the movement, which some converters of the CMU captures add, is
  left out: no body leaves it that fast. BVH files that we write have Euler angles ZXY in degrees,
  lengths in cm and a rest pose in which every bone lies along the world's axes; every reader shows
  the same positions.
- **Motive CSV.** Versions 1.21 to 1.25, with or without labels, time codes, quality columns,
  trailing commas; bones relative to the world or to their parents. The hierarchy is in the file
  from 1.25 on; before, it is derived from bone names. The root, named after the skeleton,
  becomes `Hip`. A bone's length is the median over the take. Frame times follow the export rate,
  since written times are rounded. Gaps in a skeleton are bridged and marked.
- **Vicon Tracker CSV.** RX, RY, RZ are a rotation vector, kept continuous, so its length may
  exceed pi. This is not documented; the evidence is that bodies on one limb keep their distance in
  each other's frame: 3 % scatter with this reading, 7 % or more with any Euler order.
- **UXF trackers.** Unity's left-handed world is mirrored: p' = (x, y, -z), q' = (w, -x, -y, z).
  Euler angles turn about z, then x, then y. All zeros means not tracked. `;` between columns with
  `,` in numbers is understood.
- **AMC** needs the ASF it was made with: upload both.
- **A skeleton from markers or bodies** is fitted if a known set of them covers the body; otherwise
  the reason is given.

## Files

How the published files that the tests use are read. In brackets: where each convention comes from.
"""


@dataclass(frozen=True)
class Row:
    """The result of reading one file or several of one kind, with ranges where they differ."""

    name: str
    outcome: str
    frames: str
    rate: str
    unit: str
    axes: str
    skeleton: str

    @property
    def line(self) -> str:
        """Return the row in Markdown."""
        cells = (
            f"`{self.name}`",
            self.outcome,
            self.frames,
            self.rate,
            self.unit,
            self.axes,
            self.skeleton,
        )
        return f"| {' | '.join(cell.replace('|', '/') for cell in cells)} |"


def page(data: Path) -> str:
    """Return the whole document."""
    formats = ["| format | files | gives | unit | axes | rotations |", "|---|---|---|---|---|---|"]
    for known in FORMATS:
        cells = (
            known.title,
            " ".join(f"`{end}`" for end in known.extensions),
            *_FORMATS[known.key],
        )
        formats.append(f"| {' | '.join(cells)} |")
    files = [
        "| file | read as, or why not | frames | rate | unit | axes | skeleton |",
        "|---|---|---|---|---|---|---|",
        *(row.line for row in rows(data)),
    ]
    return "\n".join([_INTRODUCTION, *formats, _DETAILS, *files, ""])


def rows(data: Path) -> Iterator[Row]:
    """Yield the result of each shared file; the trackers of UXF sessions have one row per kind."""
    kinds: dict[str, list[Row]] = {}
    for path in files(data):
        name = path.relative_to(data).as_posix()
        kinds.setdefault(_kind(name), []).append(row_of(path, name))
    for kind, some in sorted(kinds.items()):
        yield some[0] if len(some) == 1 else _together(kind, some)


def files(data: Path) -> list[Path]:
    """Return the shared files of captures and logs."""
    found = (path for folder in _FOLDERS for path in sorted((data / folder).rglob("*")))
    return [
        path
        for path in found
        if path.is_file() and not path.relative_to(data).as_posix().startswith(_LEFT_ASIDE)
    ]


def row_of(path: Path, name: str) -> Row:
    """Read a file, with the skeleton files of its folder as companions."""
    companions = {other.name: other.read_bytes() for other in sorted(path.parent.glob("*.asf"))}
    try:
        capture = read_capture(
            path.read_bytes(), name=path.name, reading=Reading(companions=companions)
        )
    except CaptureError as error:
        told = str(error).split("; captures that can be read are")[0]
        return Row(name, f"refused: {_first_sentence(told)}", "", "", "", "", "")
    conventions = capture.conventions
    return Row(
        name,
        _what(capture),
        str(capture.motion.frame_count),
        f"{capture.motion.rate_hz:.4g} Hz",
        f"{conventions.length.value} ({conventions.length.origin})",
        f"{conventions.axes.value} ({conventions.axes.origin})",
        _skeleton(capture),
    )


def _what(capture: Capture) -> str:
    motion = capture.motion
    if isinstance(motion, RigMotion):
        return f"{capture.format}: skeleton of {motion.rig.joint_count} joints"
    many = len(motion.names) != 1
    if isinstance(motion, MarkerMotion):
        return f"{capture.format}: {len(motion.names)} marker{'s' if many else ''}"
    return f"{capture.format}: {len(motion.names)} rigid bod{'ies' if many else 'y'}"


def _skeleton(capture: Capture) -> str:
    motion = capture.motion
    if isinstance(motion, RigMotion):
        return "its own"
    try:
        fitted = fit_skeleton(motion)
    except FitError as error:
        return f"none: {_first_sentence(str(error))}"
    joints = fitted.motion.rig.joint_count
    return f"fitted, {joints} joints, {1000 * fitted.residual_m:.0f} mm rms"


def _first_sentence(text: str) -> str:
    first = re.split(r"(?<=[a-z0-9)'])\. ", text)[0].rstrip(".")
    return first if len(first) <= 240 else f"{first[:237]}..."


def _kind(name: str) -> str:
    """Return the kind of a file; the files of one UXF tracker, one per trial, are of one kind."""
    if not name.startswith("logs/uxf/"):
        return name
    return "logs/uxf/*/" + re.sub(r"_T\d+", "_T*", name.rsplit("/", 1)[1])


def _together(kind: str, some: list[Row]) -> Row:
    frames = sorted(int(row.frames) for row in some if row.frames)
    outcomes = sorted({row.outcome for row in some})
    first = some[0]
    return Row(
        kind,
        " / ".join(outcomes) + f" ({len(some)} files)",
        f"{frames[0]}-{frames[-1]}" if frames else "",
        first.rate,
        first.unit,
        first.axes,
        first.skeleton,
    )


if __name__ == "__main__":
    sys.stdout.write(page(shared_data_folder()))
