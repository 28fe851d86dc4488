"""The messages that a NatNet client sends: connect, ask for the definitions, stay connected."""

import struct

CONNECT, SERVER_INFO, MODEL_REQUEST, MODEL_DEFINITIONS, FRAME = 0, 1, 4, 5, 7
KEEP_ALIVE = 10
COMMAND_PORT = 1510
"""The port on which Motive answers requests, by default."""
DATA_PORT = 1511
"""The port to which Motive sends multicast data, by default."""
MULTICAST_GROUP = "239.255.42.99"
NEWEST = (4, 1)
"""The newest version whose layout is read; newer servers are asked for this one."""
NAME_BYTES = 256
_CLIENT = b"Reembody"


def connect_request() -> bytes:
    """Return the request to connect; the server answers with its name and version.

    After the name come the client's own version (4 bytes, unused), the version of NatNet that it
    speaks, and for servers of 4.0 and newer that it wants all data, in the version it speaks.
    """
    version = bytes((*NEWEST, 0, 0))
    body = _CLIENT.ljust(NAME_BYTES, b"\0") + bytes(4) + version + b"\0" + version
    return struct.pack("<HH", CONNECT, len(body)) + body


def model_request() -> bytes:
    """Return the request for the names of rigid bodies and bones."""
    return struct.pack("<HH", MODEL_REQUEST, 0)


def keep_alive() -> bytes:
    """Return the message without which a server stops unicast data after some seconds."""
    return struct.pack("<HH", KEEP_ALIVE, 0)
