"""Send a movement the way each kind of tracking software sends skeletons."""

import json
from collections.abc import Callable, Iterator

import numpy as np

from app.adapters.live import JsonTrackers, NatNetClient, OscTrackers, Reading
from app.features.movement.live.sources import DoorKey, Sample, Source, SourceKey
from app.science.retargeting import example_walk
from app.science.rig import RigMotion
from app.science.rotations import normalise
from tests.adapters.live.packets import bundle, definitions, frame, osc, server_info

SKELETON = "Skeleton 001"
ORDER = 7
"""The id of the skeleton in NatNet's packets."""
Datagrams = Iterator[bytes]


def part_of_walk(first: int, last: int) -> RigMotion:
    """Return some frames of the generated walk."""
    whole, part = example_walk(), slice(first, last)
    return RigMotion(
        whole.rig,
        whole.rate_hz,
        whole.root_positions_m[part],
        whole.rotations[part],
        whole.observed[part],
    )


def as_sent(motion: RigMotion) -> RigMotion:
    """Return a movement with the precision of the packets of VMC and NatNet, 32 bits."""
    rotations = normalise(motion.rotations.astype(np.float32).astype(np.float64))
    roots = motion.root_positions_m.astype(np.float32).astype(np.float64)
    return RigMotion(motion.rig, motion.rate_hz, roots, rotations, motion.observed)


def by_json(motion: RigMotion, source: str = "mime") -> Datagrams:
    """Yield a packet of a script for each frame, every bone in its parent."""
    rig = motion.rig
    offsets = rig.offsets_m.tolist()
    for at in range(motion.frame_count):
        trackers = {}
        for joint, name in enumerate(rig.names):
            tracker = {
                "position_m": offsets[joint],
                "rotation_wxyz": motion.rotations[at, joint].tolist(),
                "parent": rig.names[rig.parents[joint]],
            }
            if joint == 0:
                tracker["position_m"] = motion.root_positions_m[at].tolist()
                del tracker["parent"]
            trackers[name] = tracker
        said = {"source": source, "frame": at, "time_s": at / motion.rate_hz, "trackers": trackers}
        yield json.dumps(said).encode()


def by_vmc(motion: RigMotion, *, packets: int = 1) -> Datagrams:
    """Yield the bundles of a VMC performer: its bones in Unity's axes, over several packets.

    The avatar's root is turned and moved, and the hips are in it.
    """
    rig = motion.rig
    for at in range(motion.frame_count):
        x, y, z = motion.root_positions_m[at].tolist()
        messages = []
        for joint, name in enumerate(rig.names):
            place = (x, y, z) if joint == 0 else tuple(rig.offsets_m[joint].tolist())
            messages.append(_vmc("Bone", name, place, motion.rotations[at, joint].tolist()))
        size = -(-len(messages) // packets)
        time = osc("/VMC/Ext/T", at / motion.rate_hz)
        for first in range(0, len(messages), size):
            yield bundle(time, *messages[first : first + size])


def _vmc(what: str, name: str, place: tuple[float, ...], rotation: list[float]) -> bytes:
    """Return a pose in Unity's axes, which have z the other way."""
    (x, y, z), (w, qx, qy, qz) = place, rotation
    return osc(f"/VMC/Ext/{what}/Pos", name, x, y, -z, -qx, -qy, qz, w)


def natnet_definitions(motion: RigMotion, *, shuffled: bool = False) -> bytes:
    """Return Motive's definition of the skeleton of a movement; ids are from 1."""
    rig = motion.rig
    order = list(range(rig.joint_count))
    if shuffled:
        order.reverse()
    bones = {joint + 1: rig.names[joint] for joint in order}
    tree = {
        joint + 1: (rig.parents[joint] + 1, rig.offsets_m[joint].tolist() if joint else (0, 0, 0))
        for joint in order
    }
    return definitions((3, 0), {}, {ORDER: (SKELETON, bones)}, tree)


def by_natnet(motion: RigMotion, *, in_parent: bool, shuffled: bool = False) -> Datagrams:
    """Yield Motive's answers, then a frame for each of the movement's."""
    yield server_info((3, 0))
    yield natnet_definitions(motion, shuffled=shuffled)
    rig = motion.rig
    places, world = motion.world()
    if in_parent:
        places, world = np.broadcast_to(rig.offsets_m, places.shape).copy(), motion.rotations
        places[:, 0] = motion.root_positions_m
    for at in range(motion.frame_count):
        rows = [
            (joint + 1, tuple(places[at, joint].tolist()), tuple(world[at, joint].tolist()), True)
            for joint in range(rig.joint_count)
        ]
        yield frame((3, 0), at, at / motion.rate_hz, (), {ORDER: rows})


def samples(
    door: DoorKey, datagrams: Datagrams, *, address: str = "127.0.0.1:5", start_s: float = 100.0
) -> Iterator[Sample]:
    """Yield what a door's follower gets of datagrams that arrive every 4 ms."""
    read: Callable[[bytes], Reading] = {
        "json": JsonTrackers().read,
        "osc": OscTrackers().read,
        "natnet": NatNetClient().read,
    }[door]
    source: Source | None = None
    for number, datagram in enumerate(datagrams):
        reading, arrival_s = read(datagram), start_s + 0.004 * number
        if source is None:
            key = SourceKey(door, address, reading.source)
            source = Source(key, arrival_s, arrival_s)
        sample = source.note(reading, arrival_s)
        if sample is not None:
            yield sample
