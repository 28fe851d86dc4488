"""Tests that compressed and quantised models are the same bodies as plain ones."""

import sys
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from app.adapters.humanoids import HumanoidFileError, read_humanoid, read_skin
from app.adapters.humanoids.meshopt import StreamError, decoded
from app.science.avatar.body import PART_NAMES, figure_of
from tests.support.compressed_files import (
    attributes_stream,
    draco_file,
    indices_stream,
    meshopt_file,
    triangles_stream,
)
from tests.support.humanoid_files import glb, humanoid_file, taken_apart
from tests.support.humanoid_model import Model
from tests.support.shared_data import shared_data_folder

VALID = shared_data_folder() / "models" / "valid"
needs_valid = pytest.mark.skipif(not VALID.is_dir(), reason="the VALID avatars are not there")


@pytest.mark.parametrize(
    ("compress", "within_m"), [(meshopt_file, 1e-6), (draco_file, 2e-5)], ids=["meshopt", "Draco"]
)
@pytest.mark.parametrize("model", [Model(arms_down_rad=0.8), Model(vrm=1, hair=True)])
def test_a_compressed_model_is_the_same_body(
    compress: Callable[[bytes], bytes], within_m: float, model: Model
) -> None:
    """A model has the same joints, skin and binding when it is compressed."""
    plain = humanoid_file(model)
    packed = compress(plain)
    one, other = read_humanoid(plain), read_humanoid(packed)
    assert np.abs(one.binding.part_from_node - other.binding.part_from_node).max() < within_m
    for part, own in one.humanoid.parts.items():
        found = other.humanoid.parts[part]
        assert found.place_m == pytest.approx(own.place_m, abs=within_m)
        lows, highs = (
            [side(skin.vertices_m, axis=0) for skin in (found, own)] for side in (np.min, np.max)
        )
        assert np.abs(lows[0] - lows[1]).max() < within_m, part
        assert np.abs(highs[0] - highs[1]).max() < within_m, part
    weights = [read_skin(data).pieces[0].weights for data in (plain, packed)]
    assert np.abs(weights[0] - weights[1]).max() < 1e-6


def test_textures_of_any_kind_do_not_hinder_reading() -> None:
    """The body of a file with WebP and KTX2 textures is read; unknown images have no size."""

    def edit(document: dict[str, Any]) -> None:
        document["extensionsRequired"] = ["EXT_texture_webp", "KHR_texture_basisu"]
        document["images"] = [
            {"bufferView": 0, "mimeType": "image/ktx2"},
            {"uri": "data:image/webp;base64,AAAA"},
            {"bufferView": 10**6},
        ]

    read = read_humanoid(humanoid_file(Model(edit=edit)))
    assert len(read.humanoid.parts) == len(PART_NAMES)
    assert [(one.width, one.height) for one in read.contents.textures] == [(0, 0)] * 3


@needs_valid
@pytest.mark.parametrize(
    ("name", "stature_m", "vertices"),
    [("Asian_F_1_Casual.glb", 1.769, 31_836), ("Black_M_1_Casual.glb", 1.864, 31_897)],
)
def test_validated_avatars_are_read(name: str, stature_m: float, vertices: int) -> None:
    """VALID's avatars (quantised, meshopt, WebP textures) have all 52 parts, each with a piece."""
    read = read_humanoid((VALID / name).read_bytes())
    figure = figure_of(read.humanoid)
    assert tuple(figure.places_m) == tuple(figure.pieces) == PART_NAMES
    assert (figure.finger_count("Left"), figure.finger_count("Right")) == (5, 5)
    assert figure.stature_m == pytest.approx(stature_m, abs=5e-4)
    assert len(figure.notes) == 1  # one length of each is just outside the usual range
    assert (read.contents.triangles, read.contents.vertices) == (58_724, vertices)
    assert [one.media_type for one in read.contents.textures] == ["image/webp"] * 2


@pytest.mark.parametrize("channel", [None, 0, 1, 2, 2 + 16 * 5])
@pytest.mark.parametrize("stride", [4, 16, 256])
def test_vertices_survive_compression(stride: int, channel: int | None) -> None:
    """Elements of any size, be they constant, slowly changing or random, survive compression."""
    rng = np.random.default_rng(stride)
    for count in (1, 17, 300):
        for table in (
            np.full((count, stride), 7),
            np.cumsum(rng.integers(-2, 3, size=(count, stride)), axis=0),
            np.cumsum(rng.integers(-9, 10, size=(count, stride)), axis=0),
            rng.integers(0, 256, size=(count, stride)),
        ):
            bytes_ = table.astype(np.uint8)
            stream = attributes_stream(bytes_, channel=channel)
            assert decoded("ATTRIBUTES", stream, count, stride, "NONE") == bytes_.tobytes()


def test_exponents_become_numbers() -> None:
    """Numbers with the exponential filter are mantissa times two to the exponent."""
    words = np.array([[3 << 24 | 5], [-2 << 24 | 7], [0], [1 << 24 | 0xFFFFFF]], dtype="<i8")
    table = words.astype("<i4").view(np.uint8).reshape(4, 4)
    plain = decoded("ATTRIBUTES", attributes_stream(table), 4, 4, "EXPONENTIAL")
    assert np.frombuffer(plain, "<f4").tolist() == [40.0, 1.75, 0.0, -2.0]


@pytest.mark.parametrize("stride", [2, 4])
def test_indices_survive_compression(stride: int) -> None:
    """Sequences of indices survive compression; triangles may begin at another corner."""
    rng = np.random.default_rng(1)
    size = "<u2" if stride == 2 else "<u4"
    grid = [
        corner
        for row in range(8)
        for column in range(8)
        for corner in (
            *(9 * row + column, 9 * row + column + 1, 9 * row + column + 9),
            *(9 * row + column + 1, 9 * row + column + 10, 9 * row + column + 9),
        )
    ]
    for corners in (list(range(99)), grid, rng.integers(0, 60_000, size=300).tolist()):
        stream = indices_stream(corners)
        plain = decoded("INDICES", stream, len(corners), stride, "NONE")
        assert np.frombuffer(plain, size).tolist() == corners
        plain = decoded("TRIANGLES", triangles_stream(corners), len(corners), stride, "NONE")
        found = np.frombuffer(plain, size).reshape(-1, 3).tolist()
        expected = np.array(corners).reshape(-1, 3).tolist()
        for (a, b, c), triangle in zip(found, expected, strict=True):
            assert triangle in ([a, b, c], [b, c, a], [c, a, b])


@pytest.mark.parametrize("mode", ["ATTRIBUTES", "TRIANGLES", "INDICES"])
def test_a_stream_that_ends_early_is_an_error(mode: str) -> None:
    """Every beginning of a stream that is not the whole of it is refused, or has other elements."""
    table = np.random.default_rng(2).integers(0, 256, size=(60, 4)).astype(np.uint8)
    corners = [0, 1, 2, 2, 1, 900, 7, 800, 3]
    stream, count = {
        "ATTRIBUTES": (attributes_stream(table), 60),
        "TRIANGLES": (triangles_stream(corners), 9),
        "INDICES": (indices_stream(corners), 9),
    }[mode]
    refused = 0
    for end in range(len(stream)):
        try:
            decoded(mode, stream[:end], count, 4, "NONE")
        except StreamError:
            refused += 1
    assert refused >= len(stream) - 16


@pytest.mark.parametrize(
    ("field", "value", "reason"),
    [
        ("count", 2**39, "more numbers than are read"),
        ("filter", "OCTAHEDRAL", "NONE and EXPONENTIAL"),
        ("byteStride", 6, "cannot have 6 bytes"),
        ("byteOffset", 2**30, "ends at byte"),
        ("mode", "INDICES", "cannot have 12 bytes"),
    ],
)
def test_lying_sizes_are_refused_before_memory_is_taken(
    field: str, value: object, reason: str
) -> None:
    """A compressed view that claims another size or kind is refused with its place."""
    document, binary = taken_apart(meshopt_file(humanoid_file()))
    document["bufferViews"][0]["extensions"]["EXT_meshopt_compression"][field] = value
    with pytest.raises(HumanoidFileError, match=reason) as caught:
        read_humanoid(glb(document, binary))
    assert caught.value.place == "bufferViews.0"


@pytest.mark.parametrize(
    ("accessor", "place"), [("POSITION", "vertices"), ("indices", "triangles")]
)
def test_draco_sizes_must_agree_with_the_file(accessor: str, place: str) -> None:
    """A Draco stream with more triangles or vertices than the file says is not decoded."""
    document, binary = taken_apart(draco_file(humanoid_file()))
    primitive = document["meshes"][0]["primitives"][0]
    number = primitive["indices"] if accessor == "indices" else primitive["attributes"][accessor]
    document["accessors"][number]["count"] //= 4
    with pytest.raises(HumanoidFileError, match=f"Draco data have .*{place}"):
        read_humanoid(glb(document, binary))


def test_draco_is_refused_with_a_remedy_where_its_decoder_is_not_installed(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Without DracoPy a model compressed by Draco is refused, saying what to install or export."""
    data = draco_file(humanoid_file())
    monkeypatch.setitem(sys.modules, "DracoPy", None)
    with pytest.raises(HumanoidFileError, match=r"reembody\[draco\]") as caught:
        read_humanoid(data)
    assert caught.value.place == "meshes.0.primitives.0"


def test_a_plain_copy_beside_the_compressed_one_is_used(monkeypatch: pytest.MonkeyPatch) -> None:
    """A file with plain tables as well, for programs without Draco, needs no decoder."""
    document, binary = taken_apart(draco_file(humanoid_file()))
    plain, tables = taken_apart(humanoid_file())
    document["accessors"] = plain["accessors"]
    assert binary.startswith(tables.rstrip(b"\0"))
    monkeypatch.setitem(sys.modules, "DracoPy", None)
    assert len(read_humanoid(glb(document, binary)).humanoid.parts) == len(PART_NAMES)
