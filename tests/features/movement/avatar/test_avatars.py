"""Tests of avatar configurations over HTTP: keys, versions, files and permissions."""

import json
from concurrent.futures import ThreadPoolExecutor
from itertools import product

import pytest
from httpx2 import Response

from app.clock import Clock
from app.features.movement.avatar.schemas import NewAvatarVersion
from app.features.movement.avatar.service import (
    add_avatar_version,
    add_shipped_avatar,
    configuration_by_hash,
    shipped_configurations,
)
from app.models import AvatarVersion, StudySession
from app.protocol.avatar import avatar_text, file_of, load_avatar, loaded
from app.protocol.avatar_editing import differences
from app.science.avatar.configuration import Configuration, lock, with_global
from app.science.avatar.mjcf import default_configuration
from tests.api.people import sign_in
from tests.features.lab import Json, Lab, error, ok

SHIPPED = default_configuration()
STANDARD = shipped_configurations()[-1]
SOFT = with_global(SHIPPED, group="head", kp=5.0)
CAST = lock(SHIPPED, "left_fingers")
PATH = "/api/avatars"


def as_json(configuration: Configuration) -> Json:
    """Return the configuration as it is sent in JSON."""
    body: Json = file_of(configuration).model_dump(mode="json")
    return body


def new(lab: Lab, key: str, configuration: Configuration = SOFT) -> Json:
    """Save a configuration as a new avatar."""
    body = {
        "key": key,
        "title": "Soft neck",
        "origin": "by_hand",
        "note": "for the pilot",
        "configuration": as_json(configuration),
    }
    view: Json = ok(lab.operator.post(PATH, json=body))
    return view


def save(
    lab: Lab, key: str, configuration: Configuration, based_on: int, origin: str = "by_hand"
) -> Json:
    """Save a configuration as a new version of an avatar."""
    view: Json = ok(
        lab.operator.post(
            f"{PATH}/{key}/versions",
            json={
                "based_on": based_on,
                "origin": origin,
                "configuration": as_json(configuration),
            },
        )
    )
    return view


@pytest.mark.one_engine
def test_a_new_installation_has_the_standard_avatar(fresh_lab: Lab) -> None:
    """A new installation has the shipped standard avatar, which no session has used."""
    (listed,) = ok(fresh_lab.operator.get(PATH))
    assert (listed["key"], listed["versions"], listed["axes"]) == ("standard", 2, 91)
    assert (listed["newest"]["origin"], listed["newest"]["by"]) == ("shipped", "system")
    assert listed["sessions"] == 0
    assert listed["newest"]["content_hash"] == loaded(STANDARD).content_hash
    view = ok(fresh_lab.operator.get(f"{PATH}/standard"))
    assert view["newest"]["configuration"] == as_json(STANDARD)
    bodies = ok(fresh_lab.operator.get("/api/humanoids"))["humanoids"]
    neutral = next(one for one in bodies if one["name"] == "neutral")
    assert (STANDARD.colliders, STANDARD.humanoid) == ("mesh", neutral["content_hash"])
    first = ok(fresh_lab.operator.get(f"{PATH}/standard/versions/1"))
    assert first["configuration"] == as_json(SHIPPED)


@pytest.mark.one_engine
def test_shipped_gains_say_where_they_come_from(fresh_lab: Lab) -> None:
    """The note of each shipped version names the origin of its gains, also of stored ones."""
    with fresh_lab.database.writing() as db:
        for number in (1, 2):
            row = db.get_one(AvatarVersion, ("standard", number))
            before = row.content_hash
            row.note = ""
    with fresh_lab.database.writing() as db:
        add_shipped_avatar(db, Clock().utc_now())
    newest, first = ok(fresh_lab.operator.get(f"{PATH}/standard"))["versions"]
    assert first["note"].startswith("Gains by rule, not tuned")
    assert newest["note"].startswith("Gains by relay tuning of the neutral body")
    assert newest["content_hash"] == before


def test_versions_are_appended_and_kept(fresh_lab: Lab) -> None:
    """Versions of an avatar are appended with author, origin and note, and stay readable."""
    first = new(fresh_lab, "soft")
    second = save(fresh_lab, "soft", CAST, 1, "tuned")
    assert [one["number"] for one in second["versions"]] == [2, 1]
    assert [one["origin"] for one in second["versions"]] == ["tuned", "by_hand"]
    assert second["newest"]["configuration"] == as_json(CAST)
    old = ok(fresh_lab.operator.get(f"{PATH}/soft/versions/1"))
    assert old == {**first["newest"], "key": "soft", "title": "Soft neck"}
    assert (old["note"], old["by"], old["report"]) == ("for the pilot", "account:admin", None)
    back = save(fresh_lab, "soft", SOFT, 2)
    assert back["newest"]["number"] == 3
    assert back["newest"]["content_hash"] == old["content_hash"]
    listed = {one["key"]: one for one in ok(fresh_lab.operator.get(PATH))}
    assert listed["soft"]["versions"] == 3
    trail = ok(fresh_lab.operator.get("/api/audit?action=avatar."))["entries"]
    assert [(one["action"], one["subject"]) for one in trail] == [
        ("avatar.version", "avatar:soft"),
        ("avatar.version", "avatar:soft"),
        ("avatar.created", "avatar:soft"),
    ]
    assert trail[1]["details"]["origin"] == "tuned"


@pytest.mark.one_engine
def test_the_same_content_is_not_saved_twice_in_a_row(fresh_lab: Lab) -> None:
    """Saving the newest content again makes no version, even if based on an older one."""
    new(fresh_lab, "soft")
    save(fresh_lab, "soft", CAST, 1)
    repeated = save(fresh_lab, "soft", CAST, 1)
    assert len(repeated["versions"]) == 2


@pytest.mark.one_engine
def test_a_note_is_never_dropped(fresh_lab: Lab) -> None:
    """A request sent twice is answered alike; another note for the same content is refused."""
    new(fresh_lab, "soft")
    body = {"based_on": 1, "origin": "by_hand", "configuration": as_json(CAST)}
    path = f"{PATH}/soft/versions"
    first = ok(fresh_lab.operator.post(path, json=body | {"note": "mine"}))
    assert ok(fresh_lab.operator.post(path, json=body | {"note": "mine"})) == first
    refusal = error(fresh_lab.operator.post(path, json=body | {"note": "yours"}), 409, "conflict")
    assert (refusal["value"], refusal["valid"]) == ("yours", "mine")
    later = {**body, "based_on": 99, "configuration": as_json(SHIPPED)}
    refusal = error(fresh_lab.operator.post(path, json=later), 422, "invalid_input")
    assert refusal["message"] == "the avatar 'soft' has no version 99"
    assert (refusal["valid"], bool(refusal["remedy"])) == ("1 to 2", True)
    for wrong in (True, "1.7"):
        trial = {"configuration": as_json(SHIPPED), "stature_m": wrong}
        refusal = error(fresh_lab.operator.post(f"{PATH}/model", json=trial), 422, "invalid_input")
        assert refusal["details"][0]["path"] == "stature_m"
    assert len(ok(fresh_lab.operator.get(f"{PATH}/soft"))["versions"]) == 2


@pytest.mark.one_engine
def test_a_key_is_no_other_value(fresh_lab: Lab) -> None:
    """A key that a study file would read as nothing, or as yes or no, is refused."""
    body = {"title": "Any", "origin": "by_hand", "configuration": as_json(CAST)}
    for key in ("null", "true", "no"):
        refusal = error(
            fresh_lab.operator.post(PATH, json=body | {"key": key}), 422, "invalid_input"
        )
        assert refusal["value"] == key


def test_saving_on_an_outdated_version_is_refused(fresh_lab: Lab) -> None:
    """Saving an avatar based on an outdated version is refused with the newest number."""
    new(fresh_lab, "soft")
    save(fresh_lab, "soft", CAST, 1)
    body = {"based_on": 1, "origin": "by_hand", "configuration": as_json(SHIPPED)}
    refusal = error(fresh_lab.operator.post(f"{PATH}/soft/versions", json=body), 409, "stale")
    assert (refusal["value"], refusal["valid"]) == (1, 2)


@pytest.mark.one_engine
def test_an_avatars_key_is_unique(fresh_lab: Lab) -> None:
    """A second avatar with the same key is refused, and the first is unchanged."""
    new(fresh_lab, "soft")
    body = {"key": "soft", "title": "Other", "origin": "loaded", "configuration": as_json(CAST)}
    error(fresh_lab.operator.post(PATH, json=body), 409, "conflict")
    assert ok(fresh_lab.operator.get(f"{PATH}/soft"))["title"] == "Soft neck"


@pytest.mark.one_engine
def test_an_unknown_avatar_is_not_found(fresh_lab: Lab) -> None:
    """The error for an unknown avatar lists the existing ones."""
    refusal = error(fresh_lab.operator.get(f"{PATH}/nobody"), 404, "not_found")
    assert refusal["valid"] == ["standard"]
    error(fresh_lab.operator.get(f"{PATH}/standard/versions/9"), 404, "not_found")


@pytest.mark.one_engine
def test_an_invalid_configuration_is_refused_with_its_path(fresh_lab: Lab) -> None:
    """Crossed limits or a missing axis are refused with their path, and nothing is saved."""
    wrong = as_json(SHIPPED)
    wrong["axes"]["HeadX"] |= {"low_deg": 20.0, "high_deg": 10.0}
    body = {"key": "wrong", "title": "Wrong", "origin": "by_hand", "configuration": wrong}
    refusal = error(fresh_lab.operator.post(PATH, json=body), 422, "invalid_config")
    (detail,) = refusal["details"]
    assert detail["path"] == "configuration.axes.HeadX.low_deg"
    assert detail["valid"] == "at most 10"
    del wrong["axes"]["HeadX"]
    refusal = error(fresh_lab.operator.post(PATH, json=body), 422, "invalid_config")
    assert refusal["details"][0]["path"] == "configuration.axes.HeadX"
    wrong["axes"]["HeadX"] = {"kp": 3.0}
    refusal = error(fresh_lab.operator.post(PATH, json=body), 422, "invalid_input")
    assert "configuration.axes.HeadX.kp" in {one["path"] for one in refusal["details"]}
    error(fresh_lab.operator.get(f"{PATH}/wrong"), 404, "not_found")


@pytest.mark.one_engine
def test_a_downloaded_configuration_can_be_loaded(fresh_lab: Lab) -> None:
    """A downloaded configuration loads with the same content and hash."""
    new(fresh_lab, "soft")
    answer = fresh_lab.operator.get(f"{PATH}/soft/versions/1/file")
    assert answer.headers["content-disposition"] == 'attachment; filename="soft-v1.json"'
    assert answer.headers["content-type"] == "application/json"
    assert answer.text == avatar_text(SOFT)
    assert load_avatar(answer.text).configuration == SOFT
    reply = ok(fresh_lab.operator.post(f"{PATH}/check", json={"text": answer.text}))
    assert (reply["ok"], reply["problems"], reply["known"]) == (True, [], [["soft", 1]])
    assert reply["configuration"] == as_json(SOFT)
    body = {
        "key": "copy",
        "title": "Copy",
        "origin": "loaded",
        "configuration": reply["configuration"],
    }
    copy = ok(fresh_lab.operator.post(PATH, json=body))
    assert copy["newest"]["content_hash"] == reply["content_hash"]


@pytest.mark.one_engine
def test_checking_an_invalid_file_reports_its_lines(fresh_lab: Lab) -> None:
    """Checking an invalid configuration file reports its problems with path and line."""
    text = avatar_text(SOFT).replace('"carried"', '"loose"')
    reply = ok(fresh_lab.operator.post(f"{PATH}/check", json={"text": text}))
    assert (reply["ok"], reply["configuration"]) == (False, None)
    (problem,) = reply["problems"]
    assert (problem["path"], problem["line"]) == ("hips", 8)


@pytest.mark.one_engine
def test_only_designers_may_change_avatars(fresh_lab: Lab) -> None:
    """Operators and analysts may read configurations, but only study designers may save them."""
    body = {"key": "own", "title": "Own", "origin": "by_hand", "configuration": as_json(SOFT)}
    for role in ("operator", "analyst"):
        client = sign_in(fresh_lab, role)
        ok(client.get(PATH))
        ok(client.get(f"{PATH}/standard/versions/1/file"))
        error(client.post(PATH, json=body), 403, "not_allowed")
        error(client.post(f"{PATH}/standard/versions", json=body), 403, "not_allowed")
    ok(sign_in(fresh_lab, "experimenter").post(PATH, json=body))


def test_sessions_are_counted_by_the_content_they_used(fresh_lab: Lab) -> None:
    """A version counts the sessions that used its content, found by the session's hash."""
    view = fresh_lab.join(kind="test")
    assert view["avatar_configuration_hash"] is None
    content_hash = new(fresh_lab, "soft")["newest"]["content_hash"]
    with fresh_lab.database.writing() as db:
        db.get_one(StudySession, view["id"]).avatar_configuration_hash = content_hash
        assert configuration_by_hash(db, content_hash) == SOFT
    assert fresh_lab.view(view["id"])["avatar_configuration_hash"] == content_hash
    save(fresh_lab, "soft", CAST, 1)
    listed = {one["key"]: one["sessions"] for one in ok(fresh_lab.operator.get(PATH))}
    assert listed == {"soft": 1, "standard": 0}
    assert ok(fresh_lab.operator.get(f"{PATH}/soft"))["newest"]["sessions"] == 0
    assert ok(fresh_lab.operator.get(f"{PATH}/soft/versions/1"))["sessions"] == 1


def test_a_release_updates_the_standard_avatar_unless_the_lab_changed_it(fresh_lab: Lab) -> None:
    """A new release adds its standard avatar as a version, unless the lab saved its own."""
    now = Clock().utc_now()
    with fresh_lab.database.writing() as db:
        row = db.get_one(AvatarVersion, ("standard", 1))
        db.delete(db.get_one(AvatarVersion, ("standard", 2)))
        older = loaded(SOFT)
        row.content_hash, row.canonical_json = older.content_hash, older.canonical_json
    for _ in range(2):
        with fresh_lab.database.writing() as db:
            add_shipped_avatar(db, now)
    view = ok(fresh_lab.operator.get(f"{PATH}/standard"))
    assert [one["number"] for one in view["versions"]] == [2, 1]
    assert view["newest"]["configuration"] == as_json(STANDARD)
    save(fresh_lab, "standard", CAST, 2)
    with fresh_lab.database.writing() as db:
        add_shipped_avatar(db, now)
    assert ok(fresh_lab.operator.get(f"{PATH}/standard"))["newest"]["number"] == 3


def test_the_canonical_form_is_what_is_stored(fresh_lab: Lab) -> None:
    """The database stores the canonical form of the whole configuration."""
    new(fresh_lab, "soft")
    with fresh_lab.database.reading() as db:
        row = db.get_one(AvatarVersion, ("soft", 1))
    assert row.canonical_json == loaded(SOFT).canonical_json
    reported = {name: value for name, value in as_json(SOFT).items() if value is not None}
    assert json.loads(row.canonical_json) == reported


def test_a_tuning_report_is_stored_with_its_version(fresh_lab: Lab) -> None:
    """The report of a tuning is stored with its version; other versions have none."""
    report = {"heuristic": "pd", "axes": [{"name": "HeadX", "overshoot_percent": 2.5}]}
    request = NewAvatarVersion(based_on=2, origin="tuned", configuration=file_of(SOFT))
    with fresh_lab.database.writing() as db:
        add_avatar_version(db, "system", "standard", request, Clock().utc_now(), report=report)
    view = ok(fresh_lab.operator.get(f"{PATH}/standard"))
    assert (view["newest"]["report"], view["newest"]["origin"]) == (report, "tuned")
    assert ok(fresh_lab.operator.get(f"{PATH}/standard/versions/1"))["report"] is None
    with fresh_lab.database.reading() as db:
        assert db.query(AvatarVersion).filter(AvatarVersion.report.is_(None)).count() == 2


def test_of_several_people_who_save_at_once_one_does(fresh_lab: Lab) -> None:
    """Of simultaneous saves under a key or on a version one is stored; the others lose nothing.

    Each of the others is told that somebody was faster, and can save after it.
    """
    people = [sign_in(fresh_lab, "experimenter") for _ in range(4)]

    def at_once(path: str, kp: float, **fields: object) -> list[Response]:
        def post(at: int) -> Response:
            content = as_json(with_global(SHIPPED, group="head", kp=kp + at))
            body = {"origin": "by_hand", "configuration": content, **fields}
            return people[at].post(path, json=body)

        with ThreadPoolExecutor(len(people)) as pool:
            return list(pool.map(post, range(len(people))))

    for replies in (
        at_once(PATH, 10.0, key="soft", title="Soft"),
        at_once(f"{PATH}/soft/versions", 20.0, based_on=1),
    ):
        refused = [reply for reply in replies if not reply.is_success]
        assert len(refused) == len(people) - 1
        assert all(reply.status_code == 409 for reply in refused)
        assert all(reply.json()["error"]["remedy"] for reply in refused)
    view = ok(fresh_lab.operator.get(f"{PATH}/soft"))
    assert [one["number"] for one in view["versions"]] == [2, 1]
    assert [one["number"] for one in save(fresh_lab, "soft", CAST, 2)["versions"]] == [3, 2, 1]


def test_any_two_versions_are_compared_and_none_can_be_changed(fresh_lab: Lab) -> None:
    """The difference between any two versions is that of their contents; no request edits one."""
    contents = [SOFT, CAST, SHIPPED, STANDARD]
    new(fresh_lab, "soft")
    for number, content in enumerate(contents[1:], start=1):
        save(fresh_lab, "soft", content, number)
    for old, new_one in product(range(4), repeat=2):
        path = f"{PATH}/soft/versions/{old + 1}/difference/{new_one + 1}"
        told = ok(fresh_lab.operator.get(path))
        expected = differences(contents[old], contents[new_one])
        assert [one["path"] for one in told["changed"]] == [one.path for one in expected]
        assert told["same"] == (old == new_one)
    for path in ("soft", "soft/versions/1"):
        for method in ("PUT", "PATCH", "DELETE"):
            answer = fresh_lab.operator.request(method, f"{PATH}/{path}", json={})
            assert answer.status_code == 405, (method, path)


@pytest.mark.one_engine
@pytest.mark.parametrize(
    ("title", "refused"),
    [
        ("Weicher Arm \U0001f9be \u5de6\u8155", ""),
        ("\u0630\u0631\u0627\u0639", ""),
        ("x" * 200, ""),
        ("x" * 201, "200"),
        ("soft\u202edrah", "turns the direction of writing"),
        ("soft\x1b", "control character"),
        ("   ", "1 character"),
    ],
)
def test_names_are_kept_as_typed_or_refused(fresh_lab: Lab, title: str, refused: str) -> None:
    """A name may have any letters; what turns writing around or hides is refused with its place."""
    body = {"key": "named", "title": title, "origin": "by_hand", "configuration": as_json(SOFT)}
    answer = fresh_lab.operator.post(PATH, json=body)
    if refused:
        said = error(answer, 422, "invalid_input")
        assert refused in str(said["details"])
        error(fresh_lab.operator.get(f"{PATH}/named"), 404, "not_found")
    else:
        assert ok(answer)["title"] == title
