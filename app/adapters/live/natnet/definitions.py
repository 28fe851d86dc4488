"""Read NatNet's definitions of models: which id is which rigid body or bone, and whose parent.

A bone's offset from its parent is told, and that a skeleton at rest is in a T-pose in which no bone
is rotated; whether frames have bones in their parent's frame or in the world is not told.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field

from app.adapters.live.natnet.fields import Fields
from app.adapters.live.readings import (
    MAX_NAME,
    MAX_POSES,
    BoneDefinition,
    Problem,
    Refused,
    SkeletonDefinition,
    Vector,
    checked_position,
)
from app.adapters.live.skeletons import in_order

MAX_SKELETONS = 32
_BONE = 0xFFFF
"""The part of an id that tells a bone; the upper half repeats the skeleton's."""
_NO_PARENT = (0, -1)
"""The parent of a root, by version; no bone has these ids."""
_NOWHERE: Vector = (0.0, 0.0, 0.0)
_SMALLEST = 5  # bytes of any definition: its kind, and at least an empty name


@dataclass(frozen=True)
class Definitions:
    """The names by id: of rigid bodies, and of each skeleton's or asset's bones.

    `skeletons` are those whose bones are one tree; `problems` counts what is wrong with the others.
    """

    rigid_bodies: dict[int, str] = field(default_factory=dict)
    bones: dict[int, dict[int, str]] = field(default_factory=dict)
    skeletons: list[SkeletonDefinition] = field(default_factory=list)
    problems: list[Problem] = field(default_factory=list)


@dataclass(frozen=True)
class _Body:
    """A rigid body or bone as it is defined; `parent` is an id among its skeleton's bones."""

    identity: int
    name: str
    parent: int
    offset_m: Vector


def read_definitions(fields: Fields) -> Definitions:
    """Return the definitions of a message; raises Refused if one cannot be read.

    Force plates, devices and cameras are skipped. Before 4.1 a kind that is not known hides all
    that follow, so it ends the reading.
    """
    found = Definitions()
    for _ in range(fields.count(_SMALLEST)):
        kind = fields.integer()
        read = _KINDS.get(kind)
        if read is not None:
            with fields.sized():
                read(fields, found)
        elif not fields.skip_sized():
            break
    return found


def _marker_set(fields: Fields, _: Definitions) -> None:
    fields.text()
    for _marker in range(fields.count(1)):
        fields.text()


def _rigid_body(fields: Fields, found: Definitions) -> None:
    body = _body(fields)
    if len(found.rigid_bodies) >= MAX_POSES:
        raise Refused("limit")
    found.rigid_bodies[body.identity] = body.name


def _skeleton(fields: Fields, found: Definitions) -> None:
    skeleton_name = fields.text()
    identity = fields.integer()
    _bones(fields, found, identity, skeleton_name)


def _bones(fields: Fields, found: Definitions, identity: int, owner: str) -> None:
    if len(found.bones) >= MAX_SKELETONS:
        raise Refused("limit")
    names = found.bones.setdefault(identity, {})
    bodies: list[_Body] = []
    for _ in range(fields.count(20)):
        body = _body(fields)
        if len(names) >= MAX_POSES:
            raise Refused("limit")
        # Two skeletons have bones of the same name; older versions of Motive put its own before it.
        own = body.name.startswith(owner)
        names[body.identity & _BONE] = body.name if own else f"{owner}_{body.name}"[:MAX_NAME]
        bodies.append(body)
    if sum(one.parent in _NO_PARENT for one in bodies) > 1:
        return  # bodies beside each other, such as those of some assets: nothing is wrong with them
    try:
        defined = in_order(list(_tree(bodies, names)))
        found.skeletons.append(SkeletonDefinition(owner[:MAX_NAME], defined, in_parent=None))
    except Refused as refused:
        found.problems.append(refused.problem)


def _tree(bodies: Iterable[_Body], names: dict[int, str]) -> Iterable[BoneDefinition]:
    """Yield the bones with their parents' names; raises Refused for one that cannot be placed."""
    for body in bodies:
        name = names[body.identity & _BONE]
        if body.parent in _NO_PARENT:
            yield BoneDefinition(name, None, _NOWHERE)
        elif (parent := names.get(body.parent & _BONE)) is None:
            raise Refused("arguments")
        else:
            yield BoneDefinition(name, parent, checked_position(body.offset_m))


def _body(fields: Fields) -> _Body:
    name = fields.text()[:MAX_NAME]
    identity, parent, offset_m = fields.integer(), fields.integer(), fields.vector()
    if fields.version >= (3, 0):
        markers = fields.count(16)
        fields.skip(16 * markers)  # positions and active labels
        if fields.version >= (4, 0):
            for _ in range(markers):
                fields.text()
    return _Body(identity, name, parent, offset_m)


def _force_plate(fields: Fields, _: Definitions) -> None:
    fields.integer()
    fields.text()
    fields.skip(4 * (2 + 3 + 144 + 12) + 8)  # sizes, origin, calibration, corners, two kinds
    for _channel in range(fields.count(1)):
        fields.text()


def _device(fields: Fields, _: Definitions) -> None:
    fields.integer()
    fields.text()
    fields.text()
    fields.skip(8)
    for _channel in range(fields.count(1)):
        fields.text()


def _camera(fields: Fields, _: Definitions) -> None:
    fields.text()
    fields.skip(28)


def _asset(fields: Fields, found: Definitions) -> None:
    name = fields.text()
    fields.integer()
    identity = fields.integer()
    _bones(fields, found, identity, name)
    for _ in range(fields.count(23)):
        fields.text()
        fields.skip(4 + 12 + 4 + 2)


_KINDS: dict[int, Callable[[Fields, Definitions], None]] = {
    0: _marker_set,
    1: _rigid_body,
    2: _skeleton,
    3: _force_plate,
    4: _device,
    5: _camera,
    6: _asset,
}
