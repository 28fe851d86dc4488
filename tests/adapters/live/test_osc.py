"""OSC packets, and the trackers that VMC and VRChat put into them."""

import math
import struct

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from app.adapters.live import OscTrackers
from app.adapters.live.osc import MAX_DEPTH, Message, read_osc
from tests.adapters.live.packets import BUNDLE, bundle, osc, vmc


def test_the_examples_of_the_specification_have_their_published_values() -> None:
    """The two messages of the examples page of the OSC 1.0 specification, byte for byte."""
    first = bytes.fromhex("2f6f7363 696c6c61 746f722f 342f6672 65717565 6e637900 2c660000 43dc0000")
    second = bytes.fromhex(
        "2f666f6f 00000000 2c696973 66660000 000003e8 ffffffff 68656c6c 6f000000 3f9df3b6 40b5b22d"
    )
    assert read_osc(first) == ([Message("/oscillator/4/frequency", (440.0,))], {})
    ((message,), problems) = read_osc(second)
    assert (message.address, message.arguments[:3], problems) == ("/foo", (1000, -1, "hello"), {})
    assert list(message.arguments[3:]) == pytest.approx([1.234, 5.678])


def test_every_type_tag_is_read_and_every_truncation_is_refused() -> None:
    """Arguments of all types, arrays flattened; no prefix of the packet is taken for a message."""
    packet = b"/all\0\0\0\0,ihtdTFNIbc[f]\0\0" + struct.pack(">iqQd", -1, -2, 3, 0.5)
    packet += struct.pack(">i", 2) + b"xy\0\0" + struct.pack(">If", 65, 1.5)
    ((message,), problems) = read_osc(packet)
    values = (-1, -2, 3, 0.5, True, False, None, math.inf, b"xy", 65, 1.5)
    assert (message.arguments, problems) == (values, {})
    for size in range(len(packet)):
        messages, problems = read_osc(packet[:size])
        assert messages == [Message("/all", ())] if size == 8 else not messages
        assert sum(problems.values()) == (size != 8)


@pytest.mark.parametrize(
    ("element", "problem"),
    [(-4, "malformed"), (0, "malformed"), (3, "malformed"), (2**31 - 1, "malformed")],
)
def test_a_bundle_of_an_impossible_size_ends(element: int, problem: str) -> None:
    """A size of -4 makes python-osc 1.10.2 read the same four bytes for ever."""
    packet = BUNDLE + struct.pack(">i", element) + b"/a\0\0,\0\0\0"
    assert read_osc(packet) == ([], {problem: 1})


def test_bundles_in_bundles_are_read_to_a_depth() -> None:
    """What is nested deeper is counted, and what stands beside it is still read."""
    deep = osc("/deep")
    for _ in range(MAX_DEPTH):
        deep = bundle(osc("/beside"), deep)
    messages, problems = read_osc(deep)
    assert [one.address for one in messages] == ["/beside"] * MAX_DEPTH + ["/deep"]
    assert not problems
    messages, problems = read_osc(bundle(deep, osc("/after")))
    assert [one.address for one in messages] == ["/beside"] * (MAX_DEPTH - 1) + ["/after"]
    assert problems == {"limit": 1}


def test_vmc_poses_come_in_our_axes() -> None:
    """Unity's forward and right, and its turn from forward to right, are ours after mirroring z."""
    half = math.sqrt(0.5)
    packet = bundle(
        osc("/VMC/Ext/OK", 1, 3, 0),
        osc("/VMC/Ext/T", 12.5),
        osc("/VMC/Ext/Root/Pos", "root", *[0.0] * 6, 1.0, *[1.0] * 6),
        osc("/VMC/Ext/Tra/Pos", "LHR-1", 1.0, 2.0, 3.0, 0.0, half, 0.0, half),
        vmc("LeftFoot", what="Bone"),
        vmc("Vive", what="Hmd"),
        vmc("Left hand", what="Con"),
        osc("/VMC/Ext/Blend/Val", "Joy", 0.5),
    )
    reading = OscTrackers().read(packet)
    assert (reading.time_s, reading.problems) == (12.5, {"unused": 2})
    kinds = {one.tracker: one.kind for one in reading.poses}
    assert kinds == {
        "root": "root",
        "LHR-1": "tracker",
        "LeftFoot": "bone",
        "Vive": "headset",
        "Left hand": "controller",
    }
    pose = reading.poses[1]
    assert pose.position_m == (1.0, 2.0, -3.0)
    # In Unity a quarter turn about y takes forward (z) to right (x); our forward is -z.
    assert pose.rotation is not None
    turned = Rotation.from_quat(pose.rotation, scalar_first=True).apply([0, 0, -1])
    np.testing.assert_allclose(turned, [1, 0, 0], atol=1e-7)


def test_vrchat_angles_are_turns_about_z_then_x_then_y() -> None:
    """The Euler angles equal turns about fixed axes in Unity's order, mirrored into our axes."""
    degrees = (20.0, -130.0, 55.0)
    packet = bundle(
        osc("/tracking/trackers/3/position", 0.5, 1.0, 0.25),
        osc("/tracking/trackers/3/rotation", *degrees),
        osc("/tracking/trackers/head/position", 0.0, 1.6, 0.0),
        osc("/tracking/trackers/9/position", 0.0, 0.0, 0.0),
    )
    reading = OscTrackers().read(packet)
    tracker, head = reading.poses
    assert (tracker.position_m, head.kind, head.rotation) == ((0.5, 1.0, -0.25), "headset", None)
    assert reading.problems == {"unused": 1}
    # A left-handed turn about an axis has the same matrix as a right-handed one in our formulas.
    unity = Rotation.from_euler("zxy", [degrees[2], degrees[0], degrees[1]], degrees=True)
    mirror = np.diag([1.0, 1.0, -1.0])
    expected = mirror @ unity.as_matrix() @ mirror
    assert tracker.rotation is not None
    actual = Rotation.from_quat(tracker.rotation, scalar_first=True).as_matrix()
    np.testing.assert_allclose(actual, expected, atol=1e-12)


@pytest.mark.parametrize(
    ("message", "problem"),
    [
        (osc("/VMC/Ext/Tra/Pos", "one", 1.0, 2.0), "arguments"),
        (osc("/VMC/Ext/Tra/Pos", *map(float, range(8))), "arguments"),
        (osc("/VMC/Ext/Tra/Pos", "one", "x", *[0.0] * 5, 1.0), "arguments"),
        (osc("/VMC/Ext/Tra/Pos", "one", *[0.0] * 7), "number"),
        (vmc("one", at=(math.nan, 0, 0)), "number"),
        (vmc("one", at=(1e9, 0, 0)), "number"),
        (vmc("n" * 65), "limit"),
        (vmc("line\nbreak"), "arguments"),
        (osc("/tracking/trackers/1/rotation", math.inf, 0.0, 0.0), "number"),
        (osc("/VMC/Ext/T", math.nan), "number"),
    ],
)
def test_a_message_that_cannot_be_used_is_counted_and_its_neighbour_kept(
    message: bytes, problem: str
) -> None:
    """One damaged tracker costs only itself."""
    reading = OscTrackers().read(bundle(message, vmc("kept")))
    assert [one.tracker for one in reading.poses] == ["kept"]
    assert reading.problems == {problem: 1}
