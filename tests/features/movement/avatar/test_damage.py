"""Tests of stored avatars and tunings whose content was damaged in the database."""

import json
import re
from datetime import UTC, datetime
from pathlib import Path

import pytest
from sqlalchemy import select

from app.cli.installation import opened_database
from app.features.design.studies import add_shipped
from app.features.movement.avatar import NewAvatar, create_avatar
from app.models import AvatarTuningRow, AvatarVersion, InstrumentVersion, StudyVersion
from app.protocol import sha256_of
from app.protocol.avatar import file_of, loaded
from app.science.avatar.configuration import with_global, without_parts
from app.science.avatar.mjcf import default_configuration
from tests.cli.invoked import Invoked
from tests.features.lab import Json, Lab, error, ok

SOFT = with_global(default_configuration(), group="head", kp=5.0)
PATH = "/api/avatars"
KINDS = ("avatars", "studies", "instruments")
NOW = datetime(2026, 5, 4, 9, 0, tzinfo=UTC)


def _new(key: str) -> NewAvatar:
    return NewAvatar(key=key, title=key, origin="by_hand", configuration=file_of(SOFT))


def _other_mass(text: str) -> str:
    """Return a content with another total mass: it can be read, but it is not what was saved."""
    changed = text.replace('"total_mass_kg":72', '"total_mass_kg":82')
    assert changed != text
    return changed


def _cut(text: str) -> str:
    return text[:500]


@pytest.mark.parametrize("damage", [_other_mass, _cut])
def test_a_damaged_version_is_named_and_never_served(fresh_lab: Lab, damage: object) -> None:
    """A version whose content does not have its hash is refused everywhere; others are listed."""
    assert callable(damage)
    for key in ("damaged", "sound"):
        ok(fresh_lab.operator.post(PATH, json=_new(key).model_dump(mode="json")))
    with fresh_lab.database.writing() as db:
        row = db.get_one(AvatarVersion, ("damaged", 1))
        row.canonical_json = damage(row.canonical_json)
    for place in (
        "",
        "/versions/1",
        "/versions/1/file",
        "/versions/1/difference/1",
        "/model?stature_m=1.75",
    ):
        answer = error(fresh_lab.operator.get(f"{PATH}/damaged{place}"), 503, "not_durable")
        assert "the database is damaged" in answer["message"], place
        assert "restore the newest backup" in answer["remedy"]
    listed = {one["key"]: one for one in ok(fresh_lab.operator.get(PATH))}
    assert set(listed) == {"damaged", "sound", "standard"}
    assert (listed["damaged"]["axes"], listed["damaged"]["locked_axes"]) == (None, None)
    assert listed["sound"]["axes"] == len(SOFT.axes)
    ok(fresh_lab.operator.get(f"{PATH}/sound"))


def test_a_damaged_tuning_does_not_hide_the_others(fresh_lab: Lab) -> None:
    """A tuning whose configuration was damaged is listed without its axes, beside the others."""
    content = loaded(SOFT)
    with fresh_lab.database.writing() as db:
        for name, text in (
            ("1" * 32, content.canonical_json),
            ("2" * 32, _cut(content.canonical_json)),
        ):
            db.add(
                AvatarTuningRow(
                    id=name,
                    content_hash=content.content_hash,
                    canonical_json=text,
                    stature_m=1.75,
                    options={"axes": ["HeadX"]},
                    state="stopped",
                    by="account:admin",
                    at=NOW,
                )
            )
    listed: list[Json] = ok(fresh_lab.operator.get("/api/avatar-tunings"))
    assert {one["id"][0]: one["axes"] for one in listed} == {"1": 1, "2": None}
    answer = error(fresh_lab.operator.get(f"/api/avatar-tunings/{'2' * 32}"), 503, "not_durable")
    assert "the database is damaged" in answer["message"]


def test_verify_names_damaged_and_incomplete_versions(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """`reembody verify` names each version that was altered, cannot be read or cannot be used."""
    monkeypatch.setenv("REEMBODY_DATA_DIR", str(tmp_path))
    monkeypatch.delenv("REEMBODY_DATABASE_URL", raising=False)
    with opened_database("test") as database, database.writing() as db:
        create_avatar(db, "tester", _new("soft"), NOW)
        add_shipped(db, NOW)
    sound = Invoked("verify").figures()
    assert {kind: sound[kind]["ok"] for kind in KINDS} == dict.fromkeys(KINDS, True)
    headless = loaded(without_parts(SOFT, frozenset({"Head"})))
    unknown = '{"format":"reembody-avatar","version":9}'
    with opened_database("test") as database, database.writing() as db:
        for key, text in ("headless", headless.canonical_json), ("newer", unknown):
            create_avatar(db, "tester", _new(key), NOW)
            row = db.get_one(AvatarVersion, (key, 1))
            row.canonical_json, row.content_hash = text, sha256_of(text)
    found = Invoked("verify").run("--json")
    avatars = json.loads(found.stdout)["avatars"]
    assert (found.exit_code, avatars["damaged"]) == (1, [])
    assert [one["key"] for one in avatars["unreadable"]] == ["newer"]
    assert [one["problem"] for one in avatars["incomplete"]] == [
        "No body can be built without Head."
    ]
    with opened_database("test") as database, database.writing() as db:
        db.delete(db.get_one(AvatarVersion, ("newer", 1)))
    result = Invoked("verify").run()
    assert result.exit_code == 0, "an incomplete version is unaltered"
    assert "not usable, though unaltered: headless version 1." in result.stdout
    assert "save a version in which this is corrected" in result.stdout
    with opened_database("test") as database, database.writing() as db:
        row = db.get_one(AvatarVersion, ("soft", 1))
        row.canonical_json = _other_mass(row.canonical_json)
        study = db.scalars(select(StudyVersion)).first()
        instrument = db.scalars(select(InstrumentVersion)).first()
        assert study is not None
        assert instrument is not None
        study.canonical_json += " "
        instrument.canonical_json = _cut(instrument.canonical_json)
    result = Invoked("verify").run()
    assert result.exit_code == 1
    assert "damaged in the database: soft version 1." in result.stdout
    assert "restore the newest backup" in result.stdout
    named = re.findall(r"The (\w+) do not verify: .*\n  damaged in .*: \S+ version", result.stdout)
    assert named == list(KINDS)
