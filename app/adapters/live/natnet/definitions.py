"""Read NatNet's definitions of models: which id is which rigid body or bone."""

from collections.abc import Callable
from dataclasses import dataclass, field

from app.adapters.live.natnet.fields import Fields
from app.adapters.live.readings import MAX_NAME, MAX_POSES, Refused

MAX_SKELETONS = 32
_SMALLEST = 5  # bytes of any definition: its kind, and at least an empty name


@dataclass(frozen=True)
class Definitions:
    """The names by id: of rigid bodies, and of each skeleton's or asset's bones."""

    rigid_bodies: dict[int, str] = field(default_factory=dict)
    bones: dict[int, dict[int, str]] = field(default_factory=dict)


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
    identity, name = _body(fields)
    if len(found.rigid_bodies) >= MAX_POSES:
        raise Refused("limit")
    found.rigid_bodies[identity] = name


def _skeleton(fields: Fields, found: Definitions) -> None:
    skeleton_name = fields.text()
    identity = fields.integer()
    _bones(fields, found, identity, skeleton_name)


def _bones(fields: Fields, found: Definitions, identity: int, owner: str) -> None:
    if len(found.bones) >= MAX_SKELETONS:
        raise Refused("limit")
    bones = found.bones.setdefault(identity, {})
    for _ in range(fields.count(20)):
        bone, name = _body(fields)
        if len(bones) >= MAX_POSES:
            raise Refused("limit")
        # Two skeletons have bones of the same name; older versions of Motive put its own before it.
        bones[bone & 0xFFFF] = name if name.startswith(owner) else f"{owner}_{name}"[:MAX_NAME]


def _body(fields: Fields) -> tuple[int, str]:
    name = fields.text()[:MAX_NAME]
    identity = fields.integer()
    fields.skip(4 + 12)  # the parent's id, and the offset from it
    if fields.version >= (3, 0):
        markers = fields.count(16)
        fields.skip(16 * markers)  # positions and active labels
        if fields.version >= (4, 0):
            for _ in range(markers):
                fields.text()
    return identity, name


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
