"""Tests of pairing tablets and headsets: a code works once, and a token opens one session."""

from concurrent.futures import ThreadPoolExecutor
from datetime import UTC, datetime, timedelta

import pytest
from fastapi.testclient import TestClient
from httpx2 import Response
from sqlalchemy import inspect, text

from app.clock import Clock
from tests.features.lab import Lab, error, ok, running_lab


def use(client: TestClient, code: str, **fields: str) -> Response:
    """Pair a device by its code."""
    return client.post("/api/devices/pair", json={"code": code, **fields})


def everything_stored(lab: Lab) -> str:
    """Return the content of the whole database as text."""
    with lab.database.reading() as db:
        tables = inspect(lab.database.engine).get_table_names()
        return repr([db.execute(text(f'SELECT * FROM "{table}"')).all() for table in tables])  # noqa: S608 - our own tables


def test_a_code_pairs_a_tablet(lab: Lab) -> None:
    """A pairing code gives a tablet an HttpOnly cookie and no token in the answer."""
    session_id = lab.join()["id"]
    tablet = lab.stranger()
    answer = use(tablet, lab.show_code(session_id, "tablet"), name="iPad")
    assert ok(answer) == {"device": "tablet", "session_id": session_id, "token": None}
    cookie = answer.headers["set-cookie"].lower()
    assert "httponly" in cookie
    assert "samesite=strict" in cookie
    assert ok(tablet.get("/api/tablet/state"))["session_id"] == session_id
    assert lab.view(session_id)["devices"][0]["name"] == "iPad"


@pytest.mark.one_engine
def test_a_name_that_turns_writing_around_is_refused_and_uses_up_no_code(lab: Lab) -> None:
    """A device's name is plain text as a title is: the refusal says which character is not."""
    session_id = lab.join()["id"]
    code, tablet = lab.show_code(session_id, "tablet"), lab.stranger()
    refused = error(use(tablet, code, name="iPad \u202e3"), 422, "invalid_input")
    assert "Character 6 is U+202E" in refused["details"][0]["message"]
    ok(use(tablet, code, name=" iPad 3 "))
    assert [one["name"] for one in lab.view(session_id)["devices"]] == ["iPad 3"]


def test_a_code_works_once(lab: Lab) -> None:
    """A second tablet with a used code is refused, and the first stays paired."""
    session_id = lab.join()["id"]
    code = lab.show_code(session_id, "tablet")
    first, second = lab.stranger(), lab.stranger()
    ok(use(first, code))
    refusal = error(use(second, code), 410, "gone")
    assert "devices that are paired keep working" in refusal["remedy"]
    assert first.get("/api/tablet/state").status_code == 200


def test_one_code_pairs_one_of_many_simultaneous_tablets(lab: Lab) -> None:
    """Of eight tablets that use one code at the same time, exactly one is paired."""
    session_id = lab.join()["id"]
    code = lab.show_code(session_id, "tablet")
    tablets = [lab.stranger() for _ in range(8)]
    with ThreadPoolExecutor(8) as pool:
        answers = list(pool.map(lambda tablet: use(tablet, code).status_code, tablets))
    assert sorted(answers) == [200, *[410] * 7]
    assert len(lab.view(session_id)["devices"]) == 1


def test_a_new_code_replaces_the_old_tablet(lab: Lab) -> None:
    """Pairing a tablet with a new code revokes the cookie of the previous tablet."""
    session_id = lab.join()["id"]
    old = lab.tablet(session_id)
    new = lab.tablet(session_id)
    refusal = error(old.get("/api/tablet/state"), 401, "not_signed_in")
    assert refusal["remedy"] == "Ask the experimenter for a new code, and enter it here."
    assert new.get("/api/tablet/state").status_code == 200


@pytest.mark.one_engine
def test_showing_a_code_does_not_unpair_the_tablet(lab: Lab) -> None:
    """Showing a new code does not unpair the tablet until the code is used."""
    session_id = lab.join()["id"]
    tablet = lab.tablet(session_id)
    lab.show_code(session_id, "tablet")
    assert tablet.get("/api/tablet/state").status_code == 200


@pytest.mark.one_engine
def test_a_newer_code_invalidates_the_older_one(lab: Lab) -> None:
    """Showing a new pairing code invalidates the older one."""
    session_id = lab.join()["id"]
    older, newer = (lab.show_code(session_id, "tablet") for _ in range(2))
    error(use(lab.stranger(), older), 410, "gone")
    ok(use(lab.stranger(), newer))


@pytest.mark.one_engine
def test_a_headset_and_a_tablet_do_not_replace_each_other(lab: Lab) -> None:
    """A session has a tablet and a headset at the same time; pairing one keeps the other."""
    session_id = lab.join()["id"]
    tablet = lab.tablet(session_id)
    lab.headset_token(session_id)
    assert tablet.get("/api/tablet/state").status_code == 200
    assert {device["kind"] for device in lab.view(session_id)["devices"]} == {"tablet", "headset"}


@pytest.mark.one_engine
def test_a_headsets_token_does_not_open_the_tablet(lab: Lab) -> None:
    """A headset's token opens nothing of the tablet, as a bearer token or as a cookie."""
    token = lab.headset_token(lab.join()["id"])
    device = lab.stranger()
    error(
        device.get("/api/tablet/state", headers={"authorization": f"Bearer {token}"}),
        401,
        "not_signed_in",
    )
    device.cookies["reembody_tablet"] = token
    error(device.get("/api/tablet/state"), 401, "not_signed_in")


@pytest.mark.one_engine
def test_a_tablet_sees_its_own_session_only(lab: Lab) -> None:
    """A tablet's cookie opens only the session that it was paired with."""
    ids = [lab.join()["id"] for _ in range(2)]
    tablets = [lab.tablet(session_id) for session_id in ids]
    seen = [ok(tablet.get("/api/tablet/state"))["session_id"] for tablet in tablets]
    assert seen == ids


@pytest.mark.one_engine
def test_an_unpaired_device_is_refused_immediately(lab: Lab) -> None:
    """A tablet that the operator unpairs is refused immediately."""
    session_id = lab.join()["id"]
    tablet = lab.tablet(session_id)
    device_id = lab.view(session_id)["devices"][0]["id"]
    assert lab.operator.delete(f"/api/sessions/{session_id}/devices/{device_id}").is_success
    error(tablet.get("/api/tablet/state"), 401, "not_signed_in")


@pytest.mark.one_engine
def test_a_device_is_revoked_in_its_own_session_only(lab: Lab) -> None:
    """Unpairing a device through a session to which it does not belong is refused as not found."""
    session_id, other = lab.join()["id"], lab.join()["id"]
    tablet = lab.tablet(session_id)
    device_id = lab.view(session_id)["devices"][0]["id"]
    answer = lab.operator.delete(f"/api/sessions/{other}/devices/{device_id}")
    error(answer, 404, "not_found")
    assert tablet.get("/api/tablet/state").status_code == 200


@pytest.mark.one_engine
def test_an_unknown_code_is_not_found(lab: Lab) -> None:
    """An unknown pairing code is refused as not found."""
    error(use(lab.stranger(), "XXX-XXX"), 404, "not_found")


@pytest.mark.one_engine
def test_a_code_may_be_typed_in_lower_case_with_spaces(lab: Lab) -> None:
    """A pairing code is accepted in lower case and with spaces or without dashes."""
    code = lab.show_code(lab.join()["id"], "tablet")
    ok(use(lab.stranger(), f" {code.lower().replace('-', ' ')} "))


def test_a_code_expires(database_url: str) -> None:
    """A pairing code expires after ten minutes."""
    now = [datetime(2030, 1, 1, tzinfo=UTC)]
    with running_lab(database_url, Clock(utc_now=lambda: now[0])) as lab:
        code = lab.show_code(lab.join()["id"], "tablet")
        now[0] += timedelta(minutes=10)
        error(use(lab.stranger(), code), 410, "gone")


@pytest.mark.one_engine
def test_guessing_codes_is_rate_limited(fresh_lab: Lab) -> None:
    """After twenty wrong pairing codes even a valid one is refused for a while."""
    code = fresh_lab.show_code(fresh_lab.join()["id"], "tablet")
    device = fresh_lab.stranger()
    for number in range(20):
        error(use(device, f"AAA-{number:03d}"), 404, "not_found")
    error(use(device, code), 429, "too_many_attempts")


def test_codes_and_tokens_are_stored_as_hashes_only(fresh_lab: Lab) -> None:
    """No table contains a pairing code or a token in clear text."""
    session_id = fresh_lab.join()["id"]
    code = fresh_lab.show_code(session_id, "tablet")
    tablet = fresh_lab.stranger()
    ok(use(tablet, code))
    waiting = fresh_lab.show_code(session_id, "tablet")
    secrets = [
        fresh_lab.headset_token(session_id),
        tablet.cookies["reembody_tablet"],
        code.replace("-", ""),
        waiting.replace("-", ""),
        fresh_lab.operator.headers["authorization"].removeprefix("Bearer "),
    ]
    stored = everything_stored(fresh_lab)
    assert [secret for secret in secrets if secret in stored] == []


@pytest.mark.one_engine
@pytest.mark.parametrize("device", ["phone", "", None])
def test_only_tablets_and_headsets_pair(lab: Lab, device: str | None) -> None:
    """A pairing code for any other device than a tablet or a headset is refused."""
    path = f"/api/sessions/{lab.join()['id']}/pairings"
    error(lab.operator.post(path, json={"device": device}), 422, "invalid_input")


@pytest.mark.one_engine
@pytest.mark.parametrize(("device", "page"), [("tablet", "/tablet"), ("headset", "/vr")])
def test_the_link_opens_the_devices_page_with_the_code(lab: Lab, device: str, page: str) -> None:
    """A pairing has a link to the device's page with the code, also as a QR code in SVG.

    It also has the address of the server, for a headset's own program.
    """
    path = f"/api/sessions/{lab.join()['id']}/pairings"
    shown = ok(lab.operator.post(path, json={"device": device}))
    assert shown["url"] == f"http://testserver{page}?code={shown['code']}"
    assert shown["qr_svg"].startswith("<svg")
    assert shown["server_url"] == "http://testserver"


@pytest.mark.one_engine
def test_no_device_is_sent_to_its_own_localhost(lab: Lab) -> None:
    """A server that only its own machine can reach gives a pairing no link and no QR code."""
    path = f"/api/sessions/{lab.join()['id']}/pairings"
    here = {"host": "localhost:8321"}
    for device in ("tablet", "headset"):
        shown = ok(lab.operator.post(path, json={"device": device}, headers=here))
        assert (shown["url"], shown["qr_svg"]) == (None, None)
        assert shown["code"]
        assert "localhost" not in str(shown)
    made = ok(lab.operator.post("/api/invitations", json={"role": "analyst"}, headers=here))
    assert made["only_here"]
    elsewhere = ok(lab.operator.post("/api/invitations", json={"role": "analyst"}))
    assert not elsewhere["only_here"]
