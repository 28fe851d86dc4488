"""Tests that `read_capture` detects formats by content and rejects unknown files."""

import re

import pytest

from app.adapters.captures import FORMATS, CaptureError, Limits, Reading, read_capture
from app.adapters.captures.formats import format_of

_HEADS = {
    "bvh": b"\xef\xbb\xbfHIERARCHY\r\nROOT Hips\r\n",
    "motive-csv": b"\xef\xbb\xbfFormat Version,1.23,Take Name,x\n\n",
    "vicon-tracker-csv": b"\xef\xbb\xbfObjects\n100\n",
    "uxf-tracker": b"time;pos_x;pos_y;pos_z;rot_x;rot_y;rot_z\n",
    "quest-log": b"HeadPosX,HeadPosY,HeadPosZ,HeadOrientationW,time\n",
    "trc": b"PathFileType\t4\t(X/Y/Z)\twalk.trc\n",
    "c3d": b"\x02\x50" + bytes(510),
    "asf-amc": b"#!OML:ASF\n:FULLY-SPECIFIED\n:DEGREES\n1\n",
}


def _key_of(data: bytes, name: str) -> str | None:
    found = format_of(data, name)
    return None if found is None else found.key


@pytest.mark.parametrize("key", _HEADS)
def test_the_format_is_detected_by_content_whatever_the_name(key: str) -> None:
    """Every format is detected by its content in a file called recording.txt."""
    assert _key_of(_HEADS[key], "recording.txt") == key
    assert key in {capture_format.key for capture_format in FORMATS}


def test_a_blank_before_the_first_word_makes_no_binary_file() -> None:
    """A text whose second byte is "P", as a C3D's is, is not taken for a C3D."""
    assert _key_of(b"\nPathFileType\t4\n", "walk.csv") == "trc"


def test_every_format_has_a_detection_test() -> None:
    """Every format is covered by the test of detection by content."""
    assert {capture_format.key for capture_format in FORMATS} == set(_HEADS)


def test_every_format_names_a_function_that_reads() -> None:
    """The function that each format names as its reader exists."""
    assert all(callable(capture_format.load_reader()) for capture_format in FORMATS)


def test_an_ambiguous_extension_gives_no_format() -> None:
    """The extension .csv, shared by four formats, identifies none; .trc identifies TRC."""
    assert _key_of(b"a,b\n1,2\n", "table.csv") is None
    assert _key_of(b"a,b\n1,2\n", "table.TRC") == "trc"


def test_an_extension_helps_where_the_content_is_broken() -> None:
    """A BVH with a misspelt first word is recognised by its extension, for a better error."""
    with pytest.raises(CaptureError, match="expected 'HIERARCHY', got 'HIERARCH'") as caught:
        read_capture(b"\nHIERARCH\nROOT Hips\n", name="walk.BVH")
    assert caught.value.line == 2


@pytest.mark.parametrize(
    ("data", "seen"),
    [
        (b"", "the file is empty"),
        (b" \n\t\n", "the file is empty"),
        (b"PK\x03\x04rest", "a ZIP archive"),
        (b"XDF:\x01\x02", "an XDF recording"),
        (b"Kaydara FBX Binary  \x00", "an FBX scene"),
        (b'{"frames": []}', "looks like JSON"),
        (b"\x07\x00\xf1\x0b\xb6\xaa", "begins with the bytes 07 00 f1 0b b6 aa"),
        (b"experiment,ppid,session_num\n1,2,3\n", "begins with 'experiment,ppid,session_num'"),
        ("länge,breite\n1,2\n".encode("latin-1"), "a text that begins with 'l"),
    ],
)
def test_unknown_content_is_rejected_with_what_was_seen(data: bytes, seen: str) -> None:
    """The error about unknown content says what it looks like and lists the formats."""
    with pytest.raises(CaptureError, match=re.escape(seen)) as caught:
        read_capture(data, name="something.dat")
    for capture_format in FORMATS:
        assert capture_format.title in str(caught.value)


def test_an_impossible_scale_is_rejected() -> None:
    """Zero, negative, infinite and astronomic units are rejected."""
    for scale in (0.0, -1.0, float("inf"), float("nan"), 1e9):
        with pytest.raises(CaptureError, match="m per unit"):
            read_capture(_HEADS["bvh"], name="a.bvh", reading=Reading(metres_per_unit=scale))


def test_a_file_above_the_limit_is_rejected_unread() -> None:
    """A file above the size limit is rejected before it is parsed."""
    with pytest.raises(CaptureError, match="up to 10 are read"):
        read_capture(b"x" * 11, name="a.bvh", limits=Limits(bytes=10))


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "latin-1"])
def test_texts_of_other_encodings_are_read(encoding: str) -> None:
    """Texts with a byte order mark, in UTF-16 or in the local code page are read."""
    text = (
        "HIERARCHY\nROOT Hüfte\n{\nOFFSET 0 1 0\nCHANNELS 3 Zrotation Xrotation Yrotation\n}\n"
        "MOTION\nFrames: 1\nFrame Time: 0.01\n0 0 0\n"
    )
    capture = read_capture(text.encode(encoding), name="walk.bvh")
    assert "Hüfte" in repr(capture.motion)


def test_an_overlong_line_is_rejected_before_it_is_split() -> None:
    """A line of more than 2,000,000 characters is rejected before it is split into words."""
    for head in (b"HIERARCHY\nROOT a\n", b"Format Version,1.23\n"):
        with pytest.raises(CaptureError, match="longer than 2000000 characters") as caught:
            read_capture(head + b"1," * 1_000_001, name="long")
        assert caught.value.line > 1
