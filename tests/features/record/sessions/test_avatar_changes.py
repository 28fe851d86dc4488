"""Tests of changes to a running avatar, from the operator's command and the study to the record."""

import json
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import pytest
from starlette.testclient import WebSocketTestSession

from app.features.record.receipts import receipt_of, receipt_text
from app.features.results.analysis.tables import phases_table
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


def joined(lab: Lab, *, cast: bool = False) -> Json:
    """Join a study with a physics avatar, which has a cast in the phase of the feet or none."""
    new(lab, "soft")
    text = study("{key: soft, version: 1}")
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
    assert "1.5" not in json.dumps(of_type(fresh_lab, view["id"], "avatar_change_reported"))


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
        view = fresh_lab.command(view, "change_avatar")
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
    outdated = fresh_lab.try_command({**view, "version": 1}, "change_avatar")
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
    view = fresh_lab.command(fresh_lab.view(view["id"]), "change_avatar")
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
        fresh_lab.command(view, "change_avatar")
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
