"""Which format a file is, by its content first and its name as a hint.

Exporters agree on extensions less than one hopes: half of the formats end in .csv.
"""

from pathlib import PurePosixPath

from app.adapters.captures.text import first_lines

# What labs also have lying about, and would otherwise wonder about.
_KNOWN_ELSEWHERE: tuple[tuple[bytes, str], ...] = (
    (b"\n\r\r\n", "a pcapng recording of network packets"),
    (b"XDF:", "an XDF recording of LabStreamingLayer"),
    (b"PK\x03\x04", "a ZIP archive"),
    (b"\x1f\x8b", "a gzip archive"),
    (b"Kaydara FBX", "an FBX scene"),
    (b"glTF", "a glTF scene"),
    (b"\x89HDF", "an HDF5 file"),
    (b"MATLAB", "a MATLAB file"),
    (b"%PDF", "a PDF"),
)
# Trackers of gaze count, so that their refusal can say what a tracker of movement has.
_TRACKED = ("pos_x", "rot_x", "dir_x", "gaze_x")
_BY_EXTENSION = {
    ".bvh": "bvh",
    ".asf": "asf-amc",
    ".amc": "asf-amc",
    ".c3d": "c3d",
    ".trc": "trc",
}


def format_of(data: bytes, name: str) -> str | None:
    """Return the key of the format, None where neither content nor name tells."""
    # A C3D begins with the number of its first block of parameters, then "P"; a text may with a
    # blank and a "P".
    if len(data) > 2 and data[1] == 0x50 and data[0] < 0x20 and data[0] not in b"\t\n\r":
        return "c3d"
    lines = [line.strip() for line in first_lines(data, 60)]
    first = next((line for line in lines if line), "")
    return (
        _by_first_line(first)
        or _by_acclaim(lines)
        or _by_columns(first)
        or _BY_EXTENSION.get(PurePosixPath(name.lower()).suffix)
    )


def what_it_looks_like(data: bytes) -> str:
    """Describe a file of no known format, for whoever chose it."""
    if not data.strip():
        return "the file is empty"
    for start, title in _KNOWN_ELSEWHERE:
        if data.startswith(start):
            return f"the file is {title}"
    sample = data[:4096]
    if b"\x00" in sample or sum(byte < 9 for byte in sample) > len(sample) // 50:
        return f"the file is binary and begins with the bytes {sample[:8].hex(' ')}"
    first = next((line.strip() for line in first_lines(data, 60) if line.strip()), "")
    if first.startswith(("{", "[")):
        return f"the file looks like JSON and begins with {first[:60]!r}"
    return f"the file is a text that begins with {first[:80]!r}"


def _by_first_line(first: str) -> str | None:
    word = first.split(maxsplit=1)[0].lower() if first else ""
    cells = [cell.strip().strip('"').lower() for cell in first.split(",")]
    if word == "hierarchy":
        return "bvh"
    if word == "pathfiletype":
        return "trc"
    if cells[0] == "format version":
        return "motive-csv"
    if cells[0] == "objects" and not any(cells[1:]):
        return "vicon-tracker-csv"
    return None


def _by_acclaim(lines: list[str]) -> str | None:
    """An ASF or AMC begins with comments and sections such as :version or :DEGREES."""
    told = next((line for line in lines if line and not line.startswith("#")), "").lower()
    sections = (":version", ":name", ":units", ":documentation", ":root", ":fully-", ":degrees")
    return "asf-amc" if told.startswith(sections) else None


def _by_columns(first: str) -> str | None:
    for separator in (",", ";", "\t"):
        columns = [cell.strip().strip('"').lower() for cell in first.split(separator)]
        if {"headposx", "headorientationw"} <= set(columns):
            return "quest-log"
        if columns[0] == "time" and any(column.endswith(_TRACKED) for column in columns):
            return "uxf-tracker"
    return None
