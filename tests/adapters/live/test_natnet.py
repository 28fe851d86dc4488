"""NatNet: public packets of Motive, and the layouts of all versions from 2.0 to 4.1."""

import re
import struct
from collections.abc import Iterator
from pathlib import Path

import pytest

from app.adapters.live import NatNetClient, connect_request, model_request
from app.adapters.live.natnet.requests import MODEL_DEFINITIONS
from tests.adapters.live.packets import Row, definitions, frame, server_info
from tests.support.shared_data import shared_data_folder

NATNET = shared_data_folder() / "motion" / "natnet"
needs_data = pytest.mark.skipif(not NATNET.is_dir(), reason="the public packets are not here")
VERSIONS = [(2, minor) for minor in range(12)] + [(3, 0), (3, 1), (4, 0), (4, 1)]


def packet(name: str) -> bytes:
    """Return a public packet."""
    return (NATNET / f"{name}.bin").read_bytes()


@needs_data
def test_a_frame_of_natnet_3_has_the_values_of_the_vendors_sample_client() -> None:
    """All 518 frames of a capture of Motive 2.1 are read; 251 of them the SampleClient printed."""
    client = NatNetClient()
    client.read(packet("serverinfo_packet_v3"))
    client.read(packet("modeldef_packet_v3"))
    assert (client.version, client.server) == ((3, 0), "Motive")
    printed = {
        int(one[1]): [float(number) for number in one[3].split()] + [float(one[2])]
        for one in re.finditer(
            r"FrameID : (\d+)\s+Timestamp : ([\d.]+).*?qw\s+([^\n]+)",
            (NATNET / "SampleClient_output.txt").read_text(),
            re.DOTALL,
        )
    }
    frames, compared = 0, 0
    for sent in udp_payloads(NATNET / "traffic.pcapng"):
        reading = client.read(sent)
        if not reading.poses:
            continue
        frames += 1
        assert not reading.problems
        (pose,) = reading.poses
        assert (pose.tracker, pose.kind) == ("RaceQuad", "rigid_body")
        if reading.frame in printed:
            x, y, z, qx, qy, qz, qw, time_s = printed[reading.frame]
            assert pose.position_m == pytest.approx((x, y, z), abs=0.0051)
            assert pose.rotation == pytest.approx((qw, qx, qy, qz), abs=0.0051)
            assert reading.time_s == pytest.approx(time_s, abs=0.0051)
            compared += 1
    assert (frames, compared) == (518, 251)


@needs_data
def test_a_frame_of_natnet_2_has_the_skeleton_of_its_definitions() -> None:
    """Motive 1.10: 21 bones with Karlie's names; offsets of bones are those of the definitions."""
    client = NatNetClient()
    assert client.read(packet("mocapframe_packet_v2")).problems == {"version": 1}
    client.read(packet("serverinfo_packet_v2"))
    client.read(packet("modeldef_packet_v2"))
    reading = client.read(packet("mocapframe_packet_v2"))
    assert client.version == (2, 10)
    assert (reading.frame, reading.problems, client.unnamed) == (109238, {}, False)
    assert reading.time_s == pytest.approx(910.3167, abs=1e-4)
    body, *bones = reading.poses
    assert (body.tracker, body.tracked, len(bones)) == ("RigidBody 1", False, 21)
    assert bones[2].tracker == "Karlie_Chest"
    # As defined, 0.2017 m above the abdomen, in another pose of the spine.
    assert bones[2].position_m == pytest.approx((0, 0.1905, 0), abs=1e-4)
    assert all(bone.tracked for bone in bones)


@needs_data
def test_a_hidden_rigid_body_is_still_read() -> None:
    """A public packet with markers hidden: the structure holds to its last byte."""
    client = NatNetClient()
    client.read(packet("serverinfo_packet_v3"))
    reading = client.read(packet("mocapframe_packet_occluded_v3"))
    assert [one.tracker for one in reading.poses] == ["7"]
    assert client.unnamed
    assert not reading.problems


@pytest.mark.parametrize("version", VERSIONS, ids=str)
def test_frames_of_every_version_come_back_as_they_were_encoded(version: tuple[int, int]) -> None:
    """Ids, positions, rotations, whether tracked, time and names, through all sections."""
    client = NatNetClient()
    client.read(server_info(version))
    client.read(definitions(version, {3: "Waist"}, {2: ("Ann", {1: "Hip", 2: "Chest"})}))
    assert client.definitions.bones == {2: {1: "Ann_Hip", 2: "Ann_Chest"}}
    rows: list[Row] = [
        (3, (0.5, 1.0, -0.25), (0.5, 0.5, -0.5, 0.5), True),
        (8, (1.0, 2.0, 3.0), (0.0, 1.0, 0.0, 0.0), False),
    ]
    skeleton: list[Row] = [(2, (0.25, 1.5, 0.0), (1.0, 0.0, 0.0, 0.0), True)]
    reading = client.read(frame(version, 41, 12.5, rows, {2: skeleton}))
    assert (reading.frame, reading.time_s, reading.problems) == (41, 12.5, {})
    found = {one.tracker: (one.position_m, one.rotation, one.tracked) for one in reading.poses}
    expected = {"Waist": rows[0][1:], "8": (*rows[1][1:3], version < (2, 6))}
    if version > (2, 0):
        expected["Ann_Chest"] = skeleton[0][1:]
    if version >= (4, 1):
        expected["9.1"] = ((1.0, 2.0, 3.0), (1.0, 0.0, 0.0, 0.0), True)
    assert found == expected
    assert client.unnamed


@pytest.mark.parametrize("version", [(2, 10), (3, 0), (4, 1)], ids=str)
def test_no_part_of_a_frame_is_taken_for_a_frame(version: tuple[int, int]) -> None:
    """Every truncation, its size corrected, and a frame read as another version are refused."""
    client, sent = NatNetClient(), frame(version, 1, 2.0, [(1, (0, 0, 0), (1, 0, 0, 0), True)])
    client.read(server_info(version))
    for size in range(4, len(sent)):
        cut = struct.pack("<HH", 7, size - 4) + sent[4:size]
        assert client.read(cut).problems == {"malformed": 1}
        assert client.read(sent[:size]).problems == {"malformed": 1}
    for other in {(2, 5), (2, 10), (3, 0), (4, 1)} - {version}:
        client.read(server_info(other))
        assert not client.read(sent).poses


def test_a_client_says_which_version_it_reads() -> None:
    """A newer server is asked for 4.1, and is then read as 4.1; one of before 2.0 is refused."""
    assert connect_request()[260 + 4 : 260 + 6] == bytes((4, 1)) == connect_request()[269:271]
    assert model_request() == struct.pack("<HH", MODEL_DEFINITIONS - 1, 0)
    client = NatNetClient()
    client.read(server_info((4, 3)))
    assert client.version == (4, 1)
    assert client.read(frame((4, 1), 1, 2.0, [(1, (0, 0, 0), (1, 0, 0, 0), True)])).frame == 1
    assert client.read(server_info((1, 9))).problems == {"version": 1}
    assert client.read(frame((4, 1), 1, 2.0)).problems == {"version": 1}


def udp_payloads(file: Path) -> Iterator[bytes]:
    """Yield the payloads of a pcapng file of UDP over IPv4 and Ethernet, little-endian."""
    data, at = file.read_bytes(), 0
    while at < len(data):
        kind, size = struct.unpack_from("<II", data, at)
        if kind == 6:  # an enhanced packet block
            (captured,) = struct.unpack_from("<I", data, at + 20)
            ethernet = data[at + 28 : at + 28 + captured]
            if ethernet[12:14] == b"\x08\x00" and ethernet[23] == 17:
                yield ethernet[14 + 4 * (ethernet[14] & 15) + 8 :]
        at += size
