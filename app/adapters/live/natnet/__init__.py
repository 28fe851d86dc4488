"""OptiTrack Motive's NatNet, versions 2.0 to 4.1: what a client sends, and how answers are read.

The layout is known from public descriptions and packets; no code of the vendor's SDK is used. All
numbers are little-endian. Motive streams metres, y up and right-handed, unless somebody has changed
its axes, which packets do not tell.
"""

from app.adapters.live.natnet.client import NatNetClient
from app.adapters.live.natnet.requests import (
    COMMAND_PORT,
    DATA_PORT,
    MULTICAST_GROUP,
    connect_request,
    keep_alive,
    model_request,
)

__all__ = [
    "COMMAND_PORT",
    "DATA_PORT",
    "MULTICAST_GROUP",
    "NatNetClient",
    "connect_request",
    "keep_alive",
    "model_request",
]
