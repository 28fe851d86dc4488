"""Read live tracking data of other software: VMC and VRChat by OSC, NatNet, and JSON of scripts.

A decoder has one method, `read(packet) -> Reading`, which never raises. Decoders open no sockets.
"""

from app.adapters.live.json_door import JsonTrackers
from app.adapters.live.natnet import (
    COMMAND_PORT,
    DATA_PORT,
    MULTICAST_GROUP,
    NatNetClient,
    connect_request,
    keep_alive,
    model_request,
)
from app.adapters.live.osc_trackers import OscTrackers
from app.adapters.live.readings import (
    BoneDefinition,
    Decoder,
    Pose,
    Problem,
    Reading,
    SkeletonDefinition,
)
from app.adapters.live.skeletons import human_skeleton

__all__ = [
    "COMMAND_PORT",
    "DATA_PORT",
    "MULTICAST_GROUP",
    "BoneDefinition",
    "Decoder",
    "JsonTrackers",
    "NatNetClient",
    "OscTrackers",
    "Pose",
    "Problem",
    "Reading",
    "SkeletonDefinition",
    "connect_request",
    "human_skeleton",
    "keep_alive",
    "model_request",
]
