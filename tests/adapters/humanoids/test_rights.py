"""Tests of what is read about a model's author, its licence, and what it costs to draw."""

import struct
from typing import Any

import pytest

from app.adapters.humanoids import Contents, ModelRights, read_humanoid
from app.adapters.humanoids.contents import size_of_image
from tests.support.humanoid_files import humanoid_file
from tests.support.humanoid_model import Model
from tests.support.shared_data import shared_data_folder

GODETTE = shared_data_folder() / "models" / "vrm" / "Godette_vrm_v4.vrm"
ALLOWANCES = (
    *("allowExcessivelyViolentUsage", "allowExcessivelySexualUsage"),
    *("allowPoliticalOrReligiousUsage", "allowAntisocialOrHateUsage", "allowRedistribution"),
)
"""The permissions of VRM 1.0 that are yes or no."""
Json = dict[str, Any]


def rights(meta: Json | None, *, vrm: Any = None, asset: Json | None = None) -> ModelRights:
    """Return what is read from a model with this `meta`, and this `asset` besides its version."""

    def edit(document: Json) -> None:
        document["asset"] |= asset or {}
        if meta is not None:
            document["extensions"]["VRM" if vrm == 0 else "VRMC_vrm"]["meta"] = meta

    return read_humanoid(humanoid_file(Model(vrm=vrm, edit=edit))).rights


@pytest.mark.parametrize(
    ("licence", "redistribution", "modification", "commercial", "credit"),
    [
        ("CC0", "allowed", "allowed", "allowed", False),
        ("CC_BY", "allowed", "allowed", "allowed", True),
        ("CC_BY_NC", "allowed", "allowed", "forbidden", True),
        ("CC_BY_ND", "allowed", "forbidden", "allowed", True),
        ("CC_BY_NC_ND", "allowed", "forbidden", "forbidden", True),
        ("Redistribution_Prohibited", "forbidden", "unknown", "allowed", None),
        ("Other", "unknown", "unknown", "allowed", None),
    ],
)
def test_a_licence_of_vrm_0_says_what_is_allowed(
    licence: str, redistribution: str, modification: str, commercial: str, credit: Any
) -> None:
    """Terms follow from the licence's name; the stricter of two statements counts."""
    found = rights(
        {
            "title": "Figure",
            "author": "A. Author",
            "allowedUserName": "ExplicitlyLicensedPerson",
            "violentUssageName": "Disallow",
            "sexualUssageName": "Disallow",
            "commercialUssageName": "Allow",
            "licenseName": licence,
        },
        vrm=0,
    )
    assert (found.title, found.authors, found.wearers) == ("Figure", ("A. Author",), "licensed")
    assert (found.violent, found.sexual, found.political) == ("forbidden", "forbidden", "unknown")
    assert (found.redistribution, found.modification) == (redistribution, modification)
    assert (found.commercial, found.credit_needed) == (commercial, credit)
    assert found.wearing_needs_permission
    assert found.licence_url.startswith("https://creativecommons.org/") == ("CC" in licence)


def test_terms_of_vroid_hub_are_in_an_address() -> None:
    """A VRM 0 file of VRoid Hub has its terms in the address of its licence, and only there."""
    terms = "modification=allow&redistribution=disallow&credit=necessary&violent_expression=allow"
    for url, modification, redistribution, credit in (
        (f"https://hub.vroid.com/license?{terms}", "allowed", "forbidden", True),
        (f"https://hub.vroid.com.example.org/license?{terms}", "unknown", "unknown", None),
        ("https://[", "unknown", "unknown", None),
    ):
        found = rights(
            {
                "licenseName": "Other",
                "otherPermissionUrl": url,
                "allowedUserName": "OnlyAuthor",
                "violentUssageName": "Disallow",
            },
            vrm=0,
        )
        assert (found.modification, found.redistribution) == (modification, redistribution)
        assert (found.credit_needed, found.violent) == (credit, "forbidden")


def test_vrm_1_forbids_what_it_does_not_allow() -> None:
    """A `meta` of VRM 1.0 without permissions forbids them; each can be given."""
    strict = rights({"name": "F", "authors": ["A", "B"], "licenseUrl": "https://x"}, vrm=1)
    assert (strict.authors, strict.wearers, strict.credit_needed) == (("A", "B"), "author", True)
    uses = ("violent", "sexual", "political", "antisocial", "commercial", "redistribution")
    assert {getattr(strict, use) for use in (*uses, "modification")} == {"forbidden"}
    free = rights(
        {
            "name": "F",
            "authors": ["A"],
            "licenseUrl": "https://vrm.dev/licenses/1.0/",
            "avatarPermission": "everyone",
            "commercialUsage": "corporation",
            "modification": "allowModificationRedistribution",
            "creditNotation": "unnecessary",
            **dict.fromkeys(ALLOWANCES, True),
        },
        vrm=1,
    )
    assert {getattr(free, use) for use in (*uses, "modification")} == {"allowed"}
    assert (free.wearers, free.credit_needed) == ("everyone", False)
    assert not free.wearing_needs_permission


def test_what_a_plain_gltf_says_is_read() -> None:
    """A file without VRM has at most a copyright notice and what a site wrote into it."""
    found = rights(
        None,
        asset={
            "copyright": "2026 Author\nInc.",
            "extras": {
                "author": "Author",
                "license": "CC-BY-4.0 (http://creativecommons.org/licenses/by/4.0/)",
                "title": "Walker",
                "year": 2026,
            },
        },
    )
    assert (found.copyright, found.authors, found.title) == (
        "2026 Author Inc.",
        ("Author",),
        "Walker",
    )
    assert found.licence_url == "http://creativecommons.org/licenses/by/4.0/"
    assert rights(None) == ModelRights()


@pytest.mark.parametrize("meta", [5, [], {"author": 7}, {"authors": "me"}, {"title": "x" * 10**5}])
@pytest.mark.parametrize("vrm", [0, 1])
def test_an_odd_meta_does_not_hinder_reading(meta: Any, vrm: int) -> None:
    """A body whose `meta` is of no valid form is read; nothing is known of its author."""
    assert rights(meta, vrm=vrm).authors == ()


@pytest.mark.parametrize(
    "odd",
    [{"reference": None}, {"title": 7}, {"author": "x" * 10_001}, {"contactInformation": ["me"]}],
)
def test_an_odd_field_of_vrm_0_does_not_hide_the_others(odd: Json) -> None:
    """A field that is not valid counts as absent; who may wear the body is read all the same."""
    meta = {"allowedUserName": "OnlyAuthor", "licenseName": "CC_BY_NC", **odd}
    found = rights(meta, vrm=0)
    assert (found.wearers, found.commercial, found.credit_needed) == ("author", "forbidden", True)


@pytest.mark.parametrize(
    "odd",
    [
        {"copyrightInformation": None},
        {"authors": ["A", 7]},
        {"avatarPermission": 1},
        {"avatarPermission": "OnlyAuthor"},
        {"allowRedistribution": "yes"},
        {"name": "x" * 10_001},
    ],
)
def test_an_odd_field_of_vrm_1_does_not_hide_the_others(odd: Json) -> None:
    """A field that is not valid has its default, which forbids; the others keep their values."""
    found = rights({"licenseUrl": "https://x", "modification": "allowModification", **odd}, vrm=1)
    assert (found.wearers, found.redistribution, found.authors) == ("author", "forbidden", ())
    assert (found.licence_url, found.modification) == ("https://x", "allowed")


@pytest.mark.parametrize(
    ("data", "expected"),
    [
        (b"\x89PNG\r\n\x1a\n" + bytes(8) + struct.pack(">II", 640, 480), ("image/png", 640, 480)),
        (
            b"\xff\xd8\xff\xe0\x00\x04ab\xff\xc0\x00\x0b\x08" + struct.pack(">HH", 48, 64),
            ("image/jpeg", 64, 48),
        ),
        (
            b"RIFF\0\0\0\0WEBPVP8X" + bytes(8) + bytes((0xFF, 7, 0, 0xFF, 3, 0)),
            ("image/webp", 2048, 1024),
        ),
        (
            b"RIFF\0\0\0\0WEBPVP8L\0\0\0\0\x2f" + struct.pack("<I", 511 | 255 << 14),
            ("image/webp", 512, 256),
        ),
        (
            b"RIFF\0\0\0\0WEBPVP8 " + bytes(10) + struct.pack("<HH", 512, 128),
            ("image/webp", 512, 128),
        ),
        (
            b"\xabKTX 20\xbb\r\n\x1a\n" + bytes(8) + struct.pack("<II", 32, 16),
            ("image/ktx2", 32, 16),
        ),
        (b"\xff\xd8\xff\xe0\x00\x00", ("image/jpeg", 0, 0)),
        (b"\x89PNG\r\n\x1a\n", ("", 0, 0)),
        (b"", ("", 0, 0)),
    ],
)
def test_sizes_of_images_are_in_their_headers(data: bytes, expected: tuple[str, int, int]) -> None:
    """Width and height are read from each format's header; a damaged one has none."""
    assert size_of_image(data) == expected


def test_triangles_and_vertices_are_counted() -> None:
    """A mesh's triangles are a third of its indices."""
    assert read_humanoid(humanoid_file()).contents == Contents(269, 808, ())


@pytest.mark.skipif(not GODETTE.is_file(), reason="the VRM model is not there")
def test_a_published_model_names_its_author_and_licence() -> None:
    """Godette (VRM 0) is by its author, for everyone, under CC BY."""
    read = read_humanoid(GODETTE.read_bytes())
    found = read.rights
    assert (found.title, found.authors) == ("Low-Poly Godette", ("SirRichard94",))
    assert (found.licence, found.wearers, found.credit_needed) == ("CC_BY", "everyone", True)
    assert len(read.contents.textures) == 5
    assert all(texture.width > 0 for texture in read.contents.textures)


def test_of_two_statements_of_a_file_the_stricter_one_counts() -> None:
    """A file with the extensions of both VRM versions is as restricted as the stricter one says."""
    everyone = {"avatarPermission": "everyone", "commercialUsage": "corporation"}

    def both(document: Json) -> None:
        document["extensions"]["VRMC_vrm"]["meta"] = everyone
        document["extensions"]["VRM"] = {
            "meta": {"allowedUserName": "OnlyAuthor", "commercialUssageName": "Disallow"}
        }

    found = read_humanoid(humanoid_file(Model(vrm=1, edit=both))).rights
    assert (found.wearers, found.commercial) == ("author", "forbidden")
    assert rights(everyone, vrm=1).wearers == "everyone"


def test_authors_and_addresses_are_bounded() -> None:
    """Of endless authors a few are listed and the others counted; only web addresses stay."""
    meta = {"authors": ["a" * 10_000] * 500, "licenseUrl": "javascript:alert(1)"}
    found = rights({**meta, "otherLicenseUrl": "https://example.org/terms"}, vrm=1)
    assert sum(map(len, found.authors)) < 1_100
    assert found.authors[-1] == "and 499 more"
    assert (found.licence_url, found.other_url) == ("", "https://example.org/terms")
