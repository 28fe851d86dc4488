"""Tests of changes to a running avatar, from the operator's command and the study to the record."""

import csv
import io
import json
import zipfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import pytest
from sqlalchemy import select
from starlette.testclient import WebSocketTestSession

from app.features.record.receipts import receipt_of, receipt_text
from app.features.record.sessions import ReportAvatarChange, apply_command
from app.features.results.analysis.tables import phases_table
from app.models import ClientReport
from app.platform.access import session_by_id
from tests.api.people import sign_in
from tests.features.lab import Json, Lab, error, ok
from tests.features.movement.avatar.test_avatars import new
from tests.features.movement.avatar.test_studies import KEY, study

CAST_OF_STUDY = """
        avatar_changes:
          casts: [{group: left_arm}]
          gravity: false"""
"""What the study changes in the phase of the feet."""
NO_GRAVITY: Json = {"gravity": False}
ABLE: Json = {"avatars": ["physics"], "changes_avatar": True}


@dataclass
class Wearer:
    """A headset of a session, which says what it was told last."""

    socket: WebSocketTestSession
    welcome: Json
    seq: int = 0

    def report(self, **body: Any) -> None:
        """Send a report and wait until it is on disk."""
        message = {"type": "report", "epoch": self.welcome["epoch"], "seq": self.seq, "body": body}
        self.seq += 1
        self.socket.send_json(message)
        self.hear(lambda one: one["type"] == "ack" and self.seq in nexts(one))

    def hear(self, is_it: Callable[[Json], bool]) -> Json:
        """Return the next message for which the function is true."""
        while True:
            message: Json = self.socket.receive_json()
            if is_it(message):
                return message

    def order(self, revision: int) -> Json:
        """Return the changes in force as they are sent with this revision."""

        def has(message: Json) -> bool:
            return bool(message.get("avatar_changes", {}).get("revision") == revision)

        changes: Json = self.hear(has)["avatar_changes"]
        return changes


def nexts(ack: Json) -> list[int]:
    """Return the next seqs of the reports that an acknowledgement names."""
    return [one["next_seq"] for one in ack["positions"] if one["stream"] == "reports"]


@contextmanager
def wearing(lab: Lab, token: str, **hello: Any) -> Iterator[Wearer]:
    """Connect a headset that can change its avatar, unless its hello says otherwise."""
    protocols = ["reembody.v1", f"bearer.{token}"]
    with lab.stranger().websocket_connect("/api/vr/stream", subprotocols=protocols) as socket:
        socket.send_json({"type": "hello", "protocol": 1, "client": "test", **ABLE, **hello})
        yield Wearer(socket, socket.receive_json())


def joined(lab: Lab, *, cast: bool = False, blinded: bool = False) -> Json:
    """Join a study with a physics avatar, which has a cast in the phase of the feet or none."""
    new(lab, "soft")
    text = study("{key: soft, version: 1}")
    if blinded:
        text = text.replace("operator: false", "operator: true")
    if cast:
        feet = "      - limb: foot"
        assert text.count(feet) == 1
        text = text.replace(feet, feet + CAST_OF_STUDY)
    ok(lab.operator.post("/api/studies", json={"yaml": text}))
    view: Json = ok(lab.operator.post(f"/api/studies/{KEY}/sessions", json={"kind": "test"}))
    return view


def in_the_body(lab: Lab, view: Json, wearer: Wearer) -> Json:
    """Go to the step of the body and let the headset report that the avatar has appeared."""
    lab.skip_to(view, "materialise")
    wearer.report(kind="materialised", t_s=1.0)
    return lab.view(view["id"])


def of_type(lab: Lab, session_id: str, kind: str) -> list[Json]:
    """Return the events of a type."""
    return [one for one in lab.events(session_id) if one["type"] == kind]


def test_an_operators_change_reaches_the_headset_and_the_record(fresh_lab: Lab) -> None:
    """An operator switches gravity off; the headset is told, and reports when it took effect."""
    view = joined(fresh_lab)
    token = fresh_lab.headset_token(view["id"])
    with wearing(fresh_lab, token) as wearer:
        assert "avatar_changes" not in wearer.welcome["state"]
        view = in_the_body(fresh_lab, view, wearer)
        assert "change_avatar" in view["allowed"]
        view = fresh_lab.command(
            view, "change_avatar", avatar_changes=NO_GRAVITY, reason="arms are tired"
        )
        revision = view["version"]
        told = wearer.order(revision)
        assert (told["gravity"], told["held_rad"], told["colliders"]) == (False, {}, {})
        wearer.report(kind="avatar_changes", revision=revision, t_s=7.25, applied=True)
    (changed,) = of_type(fresh_lab, view["id"], "avatar_changed")
    assert changed["by"].startswith("account:")
    assert changed["data"]["changes"] == NO_GRAVITY
    assert (changed["data"]["by"], changed["data"]["deviation"]) == ("operator", False)
    assert "tired" not in json.dumps(changed)
    (reported,) = of_type(fresh_lab, view["id"], "avatar_change_reported")
    assert reported["data"]["client_t_s"] == 7.25
    assert (reported["data"]["revision"], reported["data"]["applied"]) == (revision, True)
    with wearing(fresh_lab, token) as again:
        assert again.welcome["state"]["avatar_changes"] == told
    view = fresh_lab.command(fresh_lab.view(view["id"]), "abort", reason="enough")
    with wearing(fresh_lab, token) as after:
        assert "avatar_changes" not in after.welcome["state"]


def test_a_cast_keeps_its_angles_when_the_headset_starts_anew(fresh_lab: Lab) -> None:
    """A cast that was put on where the arm was is sent with the reported angles from then on."""
    view = joined(fresh_lab)
    token = fresh_lab.headset_token(view["id"])
    with wearing(fresh_lab, token) as wearer:
        view = in_the_body(fresh_lab, view, wearer)
        cast = {"casts": [{"group": "LeftLowerArm"}]}
        view = fresh_lab.command(view, "change_avatar", avatar_changes=cast)
        revision = view["version"]
        assert wearer.order(revision)["held_rad"] == {"LeftLowerArmX": None, "LeftLowerArmY": None}
        held = {"LeftLowerArmX": 0.125, "LeftLowerArmY": 1.5}
        told = {"revision": revision, "t_s": 9.0, "applied": True, "held_rad": held}
        wearer.report(kind="avatar_changes", **told)
    with wearing(fresh_lab, token) as again:
        assert again.welcome["state"]["avatar_changes"]["held_rad"] == held
    (reported,) = of_type(fresh_lab, view["id"], "avatar_change_reported")
    assert "1.5" not in json.dumps(reported["data"])


def test_the_studys_cast_lasts_as_long_as_its_phase(fresh_lab: Lab) -> None:
    """A cast of the study is in force from the phase's preparation until it is voided.

    An operator's change during the phase is a deviation and stays in force after it.
    """
    view = joined(fresh_lab, cast=True)
    token = fresh_lab.headset_token(view["id"])
    with wearing(fresh_lab, token) as wearer:
        in_the_body(fresh_lab, view, wearer)
        key = next(one["key"] for one in view["steps"] if one["limb"] == "foot")
        view = fresh_lab.skip_to(fresh_lab.view(view["id"]), key)
        view = fresh_lab.command(view, "begin_phase")
        (cast,) = of_type(fresh_lab, view["id"], "avatar_changed")
        assert (cast["data"]["by"], cast["data"]["phase_id"]) == ("study", 1)
        told = wearer.order(view["version"])
        assert told["gravity"] is False
        assert {name[:-1] for name in told["held_rad"]} == {
            "LeftUpperArm", "LeftLowerArm", "LeftHand",
        }  # fmt: skip
        own = {"gravity": True, "released": ["LeftHand"]}
        view = fresh_lab.command(view, "change_avatar", avatar_changes=own)
        told = wearer.order(view["version"])
        assert told["gravity"] is None
        assert {name[:-1] for name in told["held_rad"]} == {"LeftUpperArm", "LeftLowerArm"}
        (_, deviation) = of_type(fresh_lab, view["id"], "avatar_changed")
        assert (deviation["data"]["deviation"], deviation["data"]["phase_id"]) == (True, 1)
        view = fresh_lab.command(view, "skip", reason="broken off")
        after = wearer.hear(lambda one: one["type"] == "state" and one["phase"] is None)
        assert after["avatar_changes"]["held_rad"] == {}
        assert after["avatar_changes"]["revision"] > told["revision"]
        view = fresh_lab.command(view, "change_avatar", avatar_changes={})
        assert of_type(fresh_lab, view["id"], "avatar_changed")[-1]["data"]["changes"] == {}
    with fresh_lab.database.reading() as db:
        phases = phases_table(db, KEY, "test")
        receipt = receipt_of(db, view["id"])
    assert phases["avatar_changes"].tolist() == ["study and operator"]
    changes = [(one.phase_id, one.deviation, one.applied) for one in receipt.avatar_changes]
    assert changes == [(1, True, None), (None, False, None)]
    assert "in phase 1, not in the protocol, NOT confirmed by the headset" in receipt_text(receipt)


@pytest.mark.one_engine
def test_a_report_confirms_the_changes_before_it(fresh_lab: Lab) -> None:
    """A change is confirmed by the first report on its own revision or a later one."""
    view = joined(fresh_lab)
    with wearing(fresh_lab, fresh_lab.headset_token(view["id"])) as wearer:
        view = in_the_body(fresh_lab, view, wearer)

        def change(changes: Json) -> int:
            now = fresh_lab.view(view["id"])
            done = fresh_lab.command(now, "change_avatar", avatar_changes=changes)
            return int(done["version"])

        def report(revision: int, *, applied: bool) -> None:
            wearer.report(kind="avatar_changes", revision=revision, t_s=9.0, applied=applied)

        first = change(NO_GRAVITY)
        second = change({})
        report(second, applied=True)
        third = change(NO_GRAVITY)
        report(second, applied=True)
        report(third, applied=False)
        report(third, applied=True)
        last = change({})
    with fresh_lab.database.reading() as db:
        confirmed = [(one.event, one.applied) for one in receipt_of(db, view["id"]).avatar_changes]
    assert confirmed == [(first, True), (second, True), (third, False), (last, None)]


@pytest.mark.one_engine
def test_the_event_of_a_report_does_not_show_which_parts_a_body_has(fresh_lab: Lab) -> None:
    """A report without a held axis, of a body that lacks the part, leaves an event of one shape."""
    view = joined(fresh_lab)
    with wearing(fresh_lab, fresh_lab.headset_token(view["id"])) as wearer:
        view = in_the_body(fresh_lab, view, wearer)
        for part, held_rad in (("LeftHand", {}), ("RightHand", {"RightHandX": 0.2})):
            now = fresh_lab.view(view["id"])
            changes = {"casts": [{"group": part}]}
            done = fresh_lab.command(now, "change_avatar", avatar_changes=changes)
            revision = int(done["version"])
            said = {"revision": revision, "t_s": 9.0, "applied": True, "held_rad": held_rad}
            wearer.report(kind="avatar_changes", **said)
    log = fresh_lab.events(view["id"])
    told = [one["data"] for one in log if one["type"] == "avatar_change_reported"]
    assert len(told) == 2
    assert {(one["content_id"] is None, one["content_hash"] is None) for one in told} == {
        (False, False)
    }


@pytest.mark.one_engine
def test_a_change_is_refused_where_it_could_not_take_effect(fresh_lab: Lab) -> None:
    """A change is refused before the body appears, by a headset that cannot, and if outdated."""
    view = joined(fresh_lab)
    token = fresh_lab.headset_token(view["id"])

    def refused() -> str:
        view_now = fresh_lab.view(view["id"])
        reply = fresh_lab.try_command(view_now, "change_avatar", avatar_changes=NO_GRAVITY)
        return str(error(reply, 409, "not_now")["value"])

    fresh_lab.command(view, "start")
    assert refused() == "not materialised"
    with wearing(fresh_lab, token, changes_avatar=False) as wearer:
        in_the_body(fresh_lab, fresh_lab.view(view["id"]), wearer)
        assert refused() == "changes_avatar: false"
    outdated = fresh_lab.try_command({**view, "version": 1}, "change_avatar", avatar_changes={})
    error(outdated, 409, "stale")


@pytest.mark.one_engine
def test_a_client_that_cannot_change_its_avatar_is_refused_by_such_a_study(fresh_lab: Lab) -> None:
    """A study that changes the avatar refuses a headset whose program cannot do so."""
    view = joined(fresh_lab, cast=True)
    with wearing(fresh_lab, fresh_lab.headset_token(view["id"]), changes_avatar=False) as wearer:
        assert wearer.welcome["type"] == "error"
        assert "cannot change the avatar while it runs" in wearer.welcome["message"]


@pytest.mark.one_engine
def test_a_client_that_cannot_change_its_avatar_is_refused_while_it_is_changed(
    fresh_lab: Lab,
) -> None:
    """An operator's change refuses such a headset until the operator takes it back.

    They can do so although no headset is connected. The headset is then not sent the changes, whose
    field its program may not know.
    """
    view = joined(fresh_lab)
    token = fresh_lab.headset_token(view["id"])
    with wearing(fresh_lab, token) as wearer:
        view = in_the_body(fresh_lab, view, wearer)
        view = fresh_lab.command(view, "change_avatar", avatar_changes=NO_GRAVITY)
    with wearing(fresh_lab, token, changes_avatar=False) as unable:
        assert unable.welcome["type"] == "error"
        assert "an operator has changed the avatar" in unable.welcome["message"]
        assert "take the change back" in unable.welcome["remedy"]
    view = fresh_lab.command(fresh_lab.view(view["id"]), "change_avatar", avatar_changes={})
    with wearing(fresh_lab, token, changes_avatar=False) as unable:
        assert unable.welcome["type"] == "welcome"
        assert "avatar_changes" not in unable.welcome["state"]
        assert "avatar_changes" not in unable.hear(lambda one: one["type"] == "state")


@pytest.mark.one_engine
def test_changes_are_taken_back_whatever_the_headset_can_do(fresh_lab: Lab) -> None:
    """Changes that leave the avatar as configured admit any headset and can be taken back."""
    view = joined(fresh_lab)
    token = fresh_lab.headset_token(view["id"])
    with wearing(fresh_lab, token) as wearer:
        view = in_the_body(fresh_lab, view, wearer)
        view = fresh_lab.command(view, "change_avatar", avatar_changes={"gravity": True})
    with wearing(fresh_lab, token, changes_avatar=False) as unable:
        unable.hear(lambda one: one["type"] == "state")
        view = fresh_lab.view(view["id"])
        reply = fresh_lab.try_command(view, "change_avatar", avatar_changes=NO_GRAVITY)
        assert error(reply, 409, "not_now")["value"] == "changes_avatar: false"
        fresh_lab.command(view, "change_avatar", avatar_changes={})
    assert of_type(fresh_lab, view["id"], "avatar_changed")[-1]["data"]["changes"] == {}


@pytest.mark.one_engine
@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"colliders": [{"group": "left_arm", "kind": "mesh"}]}, "names no model"),
        ({"casts": [{"group": "Hips"}]}, "No axis of Hips is driven"),
        ({"gains": [{"motors": "head", "kp_nm_per_rad": 1e6}]}, "more than 8 times"),
        ({"layers": [{"layers": ["torso", "left_leg"], "collide": True}]}, "cannot be switched"),
    ],
)
def test_a_change_that_the_avatar_cannot_have_is_refused(
    fresh_lab: Lab, changes: Json, said: str
) -> None:
    """A change that does not fit the avatar's configuration is refused and not recorded."""
    view = fresh_lab.command(joined(fresh_lab), "start")
    reply = fresh_lab.try_command(view, "change_avatar", avatar_changes=changes)
    refusal = error(reply, 422, "invalid_input")
    assert said in refusal["message"]
    assert refusal["valid"]
    assert of_type(fresh_lab, view["id"], "avatar_changed") == []


@pytest.mark.one_engine
def test_a_report_on_a_change_does_not_tell_a_blinded_reader_which_body_is_worn(
    fresh_lab: Lab,
) -> None:
    """A blinded reader sees the same of a report whether or not the body has the part in the cast.

    The headset's words, which may name the body, reach nobody who must not know it: not in the
    cockpit, the event log, an export or a participant's own copy. Reports of earlier releases,
    which had content only with angles, tell nothing either.
    """
    view = joined(fresh_lab, blinded=True)
    cast = {"casts": [{"group": "LeftLowerArm"}]}
    said = "the body of the author has no LeftLowerArm"
    readers = {role: sign_in(fresh_lab, role) for role in ("operator", "experimenter")}
    with wearing(fresh_lab, fresh_lab.headset_token(view["id"])) as wearer:
        view = in_the_body(fresh_lab, view, wearer)
        held = {"LeftLowerArmX": 0.1}
        for changes, told in (
            (cast, {"applied": True, "held_rad": held}),
            (NO_GRAVITY, {"applied": True}),
            (cast, {"applied": False, "problem": said}),
        ):
            view = fresh_lab.command(view, "change_avatar", avatar_changes=changes)
            wearer.report(kind="avatar_changes", revision=view["version"], t_s=7.0, **told)
            view = fresh_lab.view(view["id"])
        # The body changes, and a headset that does not know better reports the change again.
        revision = view["avatar_changes"]["revision"]
        for _ in range(2):
            wearer.report(kind="avatar_changes", revision=revision, t_s=9.0, applied=True)
    with fresh_lab.database.writing() as db:
        row = session_by_id(db, view["id"], lock=True)
        report = ReportAvatarChange(revision=revision, applied=False, client_t_s=10.0)
        apply_command(db, fresh_lab.context, row, report, actor="headset")
    for role, client in readers.items():
        events = ok(client.get(f"/api/sessions/{view['id']}/events"))
        reports = [one["data"] for one in events if one["type"] == "avatar_change_reported"]
        assert len(reports) == 5
        assert {tuple(sorted(one)) for one in reports} == {("applied", "client_t_s", "revision")}
        shown = client.get(f"/api/sessions/{view['id']}")
        assert (shown.json()["avatar_changes"]["applied"], said in shown.text) == (False, False), (
            role
        )
    analyst = readers["experimenter"]
    exported = zipfile.ZipFile(
        io.BytesIO(analyst.get(f"/api/studies/{KEY}/export?kind=test").content)
    )
    with exported.open("events.csv") as file:
        rows = list(csv.DictReader(io.TextIOWrapper(file)))
    payloads = [
        json.loads(one["payload"]) for one in rows if one["type"] == "avatar_change_reported"
    ]
    assert len(payloads) == 5
    assert not {"content_id", "content_hash"} & {name for one in payloads for name in one}
    with fresh_lab.database.reading() as db:
        person = session_by_id(db, view["id"]).participant_id
    path = f"/api/studies/{KEY}/participants/{person}/access"
    own = zipfile.ZipFile(io.BytesIO(analyst.get(path).content)).read("words.json").decode()
    assert '"reason"' in own
    assert "LeftLowerArm" not in own


@pytest.mark.one_engine
@pytest.mark.parametrize(
    ("told", "said"),
    [
        ({"revision": 0, "applied": True}, "revision 0"),
        ({"applied": True, "problem": "it did not work"}, "cannot have been applied"),
        ({"applied": True, "held_rad": {"Nose": 1.0}}, "the axis Nose"),
        ({"applied": True, "held_rad": {"RightLowerArmX": 1.0}}, "the axis RightLowerArmX"),
    ],
)
def test_a_report_that_contradicts_the_changes_is_refused(
    fresh_lab: Lab, told: Json, said: str
) -> None:
    """A report of no revision, or that contradicts itself or the cast, is stored as refused."""
    view = joined(fresh_lab)
    with wearing(fresh_lab, fresh_lab.headset_token(view["id"])) as wearer:
        view = in_the_body(fresh_lab, view, wearer)
        cast = {"casts": [{"group": "LeftLowerArm"}]}
        view = fresh_lab.command(view, "change_avatar", avatar_changes=cast)
        body = {"kind": "avatar_changes", "revision": view["version"], "t_s": 9.0, **told}
        wearer.report(**body)
    with fresh_lab.database.reading() as db:
        newest = select(ClientReport).where(ClientReport.session_id == view["id"])
        stored = db.scalars(newest.order_by(ClientReport.seq.desc())).first()
        assert stored is not None
        assert (stored.accepted, said in (stored.refusal or "")) == (False, True)
    assert of_type(fresh_lab, view["id"], "avatar_change_reported") == []


@pytest.mark.one_engine
def test_changes_are_taken_back_by_saying_so(fresh_lab: Lab) -> None:
    """A command without `avatar_changes` is refused; an empty object takes the changes back."""
    view = joined(fresh_lab)
    with wearing(fresh_lab, fresh_lab.headset_token(view["id"])) as wearer:
        view = in_the_body(fresh_lab, view, wearer)
        view = fresh_lab.command(view, "change_avatar", avatar_changes=NO_GRAVITY)
        reply = fresh_lab.try_command(view, "change_avatar")
        assert "avatar_changes" in str(error(reply, 422, "invalid_input"))
        assert fresh_lab.view(view["id"])["avatar_changes"]["gravity"] is False
        view = fresh_lab.command(view, "change_avatar", avatar_changes={})
        assert view["avatar_changes"]["gravity"] is True
