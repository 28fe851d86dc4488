"""Parse an ASF file: sections that begin with a colon, and bones between begin and end."""

import numpy as np

from app.adapters.captures.asf_amc.skeleton import ROOT_CHANNELS, Acclaim, Bone, Vector, turn
from app.adapters.captures.asf_amc.words import Line, Lines, number, numbers
from app.adapters.captures.capture import CaptureError, Limits

_ORDERS = frozenset({"XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX"})


def read_asf(data: bytes, limits: Limits) -> Acclaim:
    """Parse an ASF file, which defines a skeleton.

    Raises:
        CaptureError: the grammar or a limit is violated; the error names the line.
    """
    out = Acclaim()
    readers = {":units": _units, ":root": _root, ":bonedata": _bones, ":hierarchy": _hierarchy}
    lines = Lines(data)
    while (line := lines.next()) is not None:
        reader = readers.get(line.words[0].lower())
        if reader is not None:
            reader(lines, out, limits)
    if not out.bones:
        raise CaptureError("the ASF has no ':bonedata' section, so there is no skeleton.")
    missing = [name for name in out.bones if name not in out.parents]
    if missing:
        raise CaptureError(f"bone {missing[0]!r} has no place in ':hierarchy'.")
    if len(out.order()) != len(out.bones) + 1:
        raise CaptureError("the ':hierarchy' runs in a circle: some bones never reach the root.")
    return out


def _units(lines: Lines, out: Acclaim, _: Limits) -> None:
    for line in lines.section():
        match line.words[0].lower():
            case "length":
                out.length_unit = number(line, 1, "the unit of length")
                if not 1e-3 <= out.length_unit <= 1e3:
                    raise CaptureError(
                        "the unit of length must be 0.001 to 1000.", line=line.number
                    )
            case "angle":
                word = line.words[1].lower() if len(line.words) > 1 else ""
                if not word.startswith(("deg", "rad")):
                    raise CaptureError(f"angle {word!r}: deg or rad is valid.", line=line.number)
                out.degrees = word.startswith("deg")


def _root(lines: Lines, out: Acclaim, _: Limits) -> None:
    order, angles, where = "XYZ", (0.0, 0.0, 0.0), 0
    for line in lines.section():
        where = line.number
        match line.words[0].lower():
            case "order":
                out.root.channels = tuple(word.upper() for word in line.words[1:])
                if sorted(out.root.channels) != sorted(ROOT_CHANNELS):
                    raise CaptureError(
                        f"the root's order must hold {' '.join(ROOT_CHANNELS)} once each.",
                        line=where,
                    )
            case "axis":
                order = _order(line, 1)
            case "position":
                out.position = _vector(line)
            case "orientation":
                angles = _vector(line)
    out.root.axis = turn(order, np.array(angles), degrees=out.degrees, line=where)


def _bones(lines: Lines, out: Acclaim, limits: Limits) -> None:
    bone: Bone | None = None
    for line in lines.section():
        word = line.words[0].lower()
        if word == "begin":
            bone = Bone()
        elif bone is None:
            raise CaptureError(f"expected 'begin', got {line.words[0][:40]!r}.", line=line.number)
        elif word == "end":
            _keep(bone, line, out, limits)
            bone = None
        else:
            _bone_line(bone, word, line, out)
    if bone is not None:
        raise CaptureError(f"bone {bone.name!r} has no 'end'.")


def _bone_line(bone: Bone, word: str, line: Line, out: Acclaim) -> None:
    match word:
        case "name":
            bone.name = " ".join(line.words[1:])
        case "direction":
            bone.direction = _vector(line)
        case "length":
            bone.length = number(line, 1, "a length")
        case "axis":
            order = _order(line, 4)
            angles = np.array(numbers(line, 1, 3))
            bone.axis = turn(order, angles, degrees=out.degrees, line=line.number)
        case "dof":
            bone.channels = tuple(word.upper() for word in line.words[1:])
            turns = set(bone.channels) <= {"RX", "RY", "RZ"}
            if not turns or len(set(bone.channels)) < len(bone.channels):
                raise CaptureError(
                    f"dof {' '.join(line.words[1:])}: a bone can turn by rx, ry, rz once each;"
                    " bones that shift or stretch cannot be read.",
                    line=line.number,
                )


def _keep(bone: Bone, line: Line, out: Acclaim, limits: Limits) -> None:
    if not bone.name or bone.name in out.bones or bone.name == "root":
        raise CaptureError(
            f"a bone is called {bone.name!r}: each needs a name of its own.", line=line.number
        )
    if bone.direction is None or bone.length is None:
        raise CaptureError(f"{bone.name!r} lacks its direction or length.", line=line.number)
    if len(out.bones) >= limits.tracks:
        raise CaptureError(f"more than {limits.tracks} bones.", line=line.number)
    out.bones[bone.name] = bone


def _hierarchy(lines: Lines, out: Acclaim, _: Limits) -> None:
    for line in lines.section():
        if line.words[0].lower() in {"begin", "end"}:
            continue
        parent, *children = line.words
        for name in line.words:
            if name not in out.bones and name != "root":
                raise CaptureError(f"there is no bone {name[:40]!r}.", line=line.number)
        for child in children:
            if child in out.parents or child in {"root", parent}:
                raise CaptureError(f"{child!r} has two parents, or itself.", line=line.number)
            out.parents[child] = parent


def _order(line: Line, place: int) -> str:
    word = line.words[place].upper() if len(line.words) > place else ""
    if word not in _ORDERS:
        raise CaptureError(
            f"the axis order is {word[:20]!r}: valid are {', '.join(sorted(_ORDERS))}.",
            line=line.number,
        )
    return word


def _vector(line: Line) -> Vector:
    x, y, z = numbers(line, 1, 3)
    return (x, y, z)
