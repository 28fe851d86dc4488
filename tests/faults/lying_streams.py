"""Simulate headsets that report one impossible thing somewhere in a correct stream.

`play(site, seed, lie)` runs one phase and returns the outcome. A lie is believed if the phase
counts and the record contains neither a rejection nor a doubt.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from app.features.record.doubts import Doubt, doubts_of
from app.models import Phase
from tests.faults.simulated_headset import (
    BOXES,
    DURATION_S,
    REFUSALS,
    ROAM_S,
    Edit,
    Frames,
    Message,
    SimulatedHeadset,
    Weather,
)
from tests.faults.simulated_site import Json, Site

Lie = Callable[[SimulatedHeadset, np.random.Generator], None]


@dataclass(frozen=True)
class Outcome:
    """The outcome of one stream: its session's status, rejections and doubts."""

    seed: int
    lie: str | None
    session_id: str
    status: str
    told: bool
    refusals: tuple[str, ...]
    doubts: tuple[Doubt, ...]
    welcomes: tuple[Json, ...]

    @property
    def believed(self) -> bool:
        """Return whether the lie was sent without causing a rejection or a doubt."""
        return self.told and not self.refusals and not self.doubts


def play(site: Site, seed: int, lie: str | None = None) -> Outcome:
    """Run one session with one phase, either correct or with the named lie."""
    rng = np.random.default_rng(seed)
    weather = Weather.drawn(rng) if lie is None or rng.random() < 0.5 else Weather()
    if lie is not None:
        # A client replaced by a network fault must not take the lie with it.
        weather = replace(weather, new_client_at_s=None)
    step = FREE if lie in OF_FREE else FOOT if lie not in OF_HAND and rng.random() < 0.2 else HAND
    simulated = weather.time_scale != 1.0
    kind = "simulated" if simulated else "test"
    session_id = site.join(kind=kind, time_scale=weather.time_scale, step=step)
    limb = {HAND: "hand", FOOT: "foot", FREE: None}[step]
    headset = SimulatedHeadset(
        site, session_id, 1, limb, rng, weather, pace=1.0 / weather.time_scale
    )
    if step == FREE:
        headset.duration_s = ROAM_S
    if lie is not None:
        LIES[lie](headset, rng)
    headset.play()
    site.summarise(session_id)
    with site.context.database.reading() as db:
        doubts = doubts_of(db, session_id)
        phase = db.get(Phase, (session_id, 1))
    # A client that skips ahead is asked for the missing messages, and none of it is stored.
    refusals = [
        str(one.get("reason") or one.get("message") or one["type"])
        for one in headset.socket.heard
        if one["type"] in (*REFUSALS, "resend")
    ]
    welcomes = tuple(one for one in headset.socket.heard if one["type"] == "welcome")
    status = "none" if phase is None else phase.status
    return Outcome(
        seed, lie, session_id, status, lie is not None, tuple(refusals), doubts, welcomes
    )


HAND, FOOT, FREE = "block1.hand", "block1.foot", "free_roam"


def _reports(what: str, change: Callable[[Json], list[Json]]) -> Edit:
    """Return an edit that changes reports of one kind, or phase reports with one `what`."""

    def edit(message: Message) -> list[Message]:
        if isinstance(message, Frames) or message["type"] != "report":
            return [message]
        body = message["body"]
        if what not in (body["kind"], body.get("what")):
            return [message]
        return [{**message, "body": one} for one in change(body)]

    return edit


def _once(change: Callable[[Json], Json], after: int = 0) -> Callable[[Json], list[Json]]:
    """Return an edit that applies `change` to one body only: the first one after `after` bodies."""
    seen = [0]

    def changed(body: Json) -> list[Json]:
        seen[0] += 1
        return [change(body) if seen[0] == after + 1 else body]

    return changed


def _frames(change: Callable[[Frames, int], Frames]) -> Edit:
    """Return an edit of frame batches; `change` receives the number of the batch."""
    seen = [0]

    def edit(message: Message) -> list[Message]:
        if not isinstance(message, Frames):
            return [message]
        seen[0] += 1
        return [change(message, seen[0])]

    return edit


def _plain(type_: str, change: Callable[[Json], list[Json]]) -> Edit:
    def edit(message: Message) -> list[Message]:
        if isinstance(message, Frames) or message["type"] != type_:
            return [message]
        return list[Message](change(message))

    return edit


def _too_fast(headset: SimulatedHeadset, rng: np.random.Generator) -> None:
    """Send the whole phase within a moment of server time: 8 s in 0.1 s."""
    headset.pace = float(rng.uniform(0.0, 0.7)) / headset.weather.time_scale
    headset.weather = Weather()


def _slow_clock(headset: SimulatedHeadset, rng: np.random.Generator) -> None:
    """Report more active time than has elapsed on the headset's own clock."""
    share = float(rng.uniform(0.0, 0.9))
    headset.edit = _reports("time_up", lambda b: [{**b, "t_s": 21.2 + share * DURATION_S}])
    headset.weather = Weather()


def _batch_ahead(claimed_s: float) -> Lie:
    """Claim the whole phase in one batch, then replace the headset, which has no time left."""

    def lie(headset: SimulatedHeadset, rng: np.random.Generator) -> None:
        headset.weather = Weather(new_client_at_s=float(rng.uniform(1.0, 3.0)))

        def ahead(frames: Frames, number: int) -> Frames:
            lies = headset.epoch == 1 and number > 10
            return replace(frames, active_s=claimed_s) if lies else frames

        headset.edit = _frames(ahead)

    return lie


def _report_backwards(headset: SimulatedHeadset, rng: np.random.Generator) -> None:
    back_s = float(rng.uniform(0.5, 20.0))
    headset.edit = _reports("ended", lambda b: [{**b, "t_s": b["t_s"] - back_s - 1.0}])


def _standing_gain(headset: SimulatedHeadset, rng: np.random.Generator) -> None:
    """Gain active time while the clock is paused."""
    headset.weather = Weather(pause=(2.0, float(rng.uniform(5.0, 60.0))))
    gained_s = float(rng.uniform(0.5, 4.0))
    jumped = [False]

    def resumed(body: Json) -> list[Json]:
        jumped[0] = True
        headset.active_s += gained_s
        return [{**body, "active_s": headset.active_s}]

    headset.edit = _reports("resumed", resumed)


def _fell(headset: SimulatedHeadset, rng: np.random.Generator) -> None:
    """Report less active time at the end of the freeze than when the time was up."""
    headset.edit = _reports("ended", lambda b: [{**b, "active_s": rng.uniform(0.0, 7.0)}])


def _odd_times(odd: Callable[[np.random.Generator], float]) -> Lie:
    def lie(headset: SimulatedHeadset, rng: np.random.Generator) -> None:
        at = int(rng.integers(20, 100))

        def change(frames: Frames, number: int) -> Frames:
            if number != at:
                return frames
            times_s = frames.times_s.copy()
            times_s[-1] = odd(rng)
            return replace(frames, times_s=times_s, flags=np.ones_like(frames.flags))

        headset.edit = _frames(change)

    return lie


def _frames_back(headset: SimulatedHeadset, rng: np.random.Generator) -> None:
    at, back_s = int(rng.integers(20, 100)), float(rng.uniform(0.2, 15.0))

    def change(frames: Frames, number: int) -> Frames:
        return frames if number != at else replace(frames, times_s=frames.times_s - back_s)

    headset.edit = _frames(change)


def _idle_frames(headset: SimulatedHeadset, rng: np.random.Generator) -> None:
    """Mark frames as paused while the clock is reported as running."""
    since = int(rng.integers(2, 60))

    def change(frames: Frames, number: int) -> Frames:
        return frames if number < since else replace(frames, flags=np.zeros_like(frames.flags))

    headset.edit = _frames(change)


def _contact(change: Callable[[Json, np.random.Generator], Json]) -> Lie:
    def lie(headset: SimulatedHeadset, rng: np.random.Generator) -> None:
        headset.edit = _reports("contact", _once(lambda b: change(b, rng), int(rng.integers(8))))

    return lie


def _completion(change: Callable[[Json, np.random.Generator], Json]) -> Lie:
    def lie(headset: SimulatedHeadset, rng: np.random.Generator) -> None:
        headset.edit = _reports("completion", _once(lambda b: change(b, rng), int(rng.integers(3))))

    return lie


def _many_completions(headset: SimulatedHeadset, rng: np.random.Generator) -> None:
    """Report more completed movements than the touched targets allow."""
    more = int(rng.integers(2, 40))

    def change(body: Json) -> list[Json]:
        return [{**body, "number": body["number"] * (more + 1) + at} for at in range(-more, 1)]

    headset.edit = _reports("completion", change)


def _in_free(kind: str) -> Lie:
    """Report a contact or a completion in free movement, which has no targets to touch."""

    def lie(headset: SimulatedHeadset, rng: np.random.Generator) -> None:
        body: Json = {
            "phase_id": 1,
            "kind": "contact",
            "surface": "hand/1/panel",
            "surface_kind": "panel",
            "box": 1,
            "side": None,
            "body_part": "RightHand",
            "effect": "green",
        }
        if kind == "completion":
            body = {
                "phase_id": 1,
                "kind": "completion",
                "number": 1,
                "duration_s": 3.0,
                "order": [1, 2, 3, 4],
                "out_of_order_touches": 0,
            }

        def before(up: Json) -> list[Json]:
            t_s, active_s = up["t_s"] - rng.uniform(0.5, 2.0), up["active_s"] - 2.0
            times = {"begin_s": t_s, "end_s": t_s + 0.1}
            times |= {"begin_active_s": active_s, "end_active_s": active_s + 0.1}
            if kind == "completion":
                times = {"t_s": t_s, "active_s": active_s}
            return [{**body, **times}, up]

        headset.edit = _reports("time_up", before)

    return lie


def _completion_after(headset: SimulatedHeadset, rng: np.random.Generator) -> None:
    """Report a completion during the freeze, after the time is up."""
    late = {
        "phase_id": 1,
        "kind": "completion",
        "duration_s": 1.0,
        "order": [1, 2, 3, 4],
        "out_of_order_touches": 0,
    }

    def after(up: Json) -> list[Json]:
        t_s = up["t_s"] + rng.uniform(0.2, 0.9)
        number = headset.completions + 1
        return [up, {**late, "number": number, "t_s": t_s, "active_s": DURATION_S}]

    headset.edit = _reports("time_up", after)


def _walk_back(headset: SimulatedHeadset, rng: np.random.Generator) -> None:
    """Report a walk back in a hand task."""

    def before(up: Json) -> list[Json]:
        walks = [{**up, "what": f"walk_back_{what}"} for what in ("started", "ended")]
        return [*walks, up]

    headset.edit = _reports("time_up", before)
    assert rng


def _given_epoch(headset: SimulatedHeadset, rng: np.random.Generator) -> None:
    headset.hello_epoch = int(rng.choice([2, 3, 7, 1000, 2**31 - 1]))
    headset.weather = Weather()


def _epoch_zero(headset: SimulatedHeadset, rng: np.random.Generator) -> None:
    at = int(rng.integers(5, 60))
    headset.edit = _frames(lambda f, n: f if n != at else replace(f, epoch=0, seq_first=0))


def _produced(headset: SimulatedHeadset, rng: np.random.Generator) -> None:
    count = int(rng.choice([10**8, 2**40, 2**53 - 1]))
    headset.edit = _plain("produced", lambda m: [{**m, "streams": {"target": count}}])


def _produced_then_true(headset: SimulatedHeadset, rng: np.random.Generator) -> None:
    headset.weather = Weather()
    wrong = {"target": int(rng.choice([10**8, 2**53 - 1])), "actual": 2**50}
    headset.edit = _plain("produced", lambda m: [{**m, "streams": wrong}, m])


def _seq(headset: SimulatedHeadset, rng: np.random.Generator) -> None:
    at, ahead = int(rng.integers(60, 140)), int(rng.choice([10**9, 2**40, 2**61]))
    headset.edit = _frames(
        lambda f, n: f if n != at else replace(f, seq_first=f.seq_first + ahead, phase_id=1)
    )


def _report_seq(headset: SimulatedHeadset, rng: np.random.Generator) -> None:
    ahead = int(rng.choice([10**9, 2**40, 2**52]))

    def edit(message: Message) -> list[Message]:
        if isinstance(message, Frames) or message["type"] != "report":
            return [message]
        if message["body"].get("what") != "ended":
            return [message]
        return [message, {**message, "seq": ahead, "odd": True}]

    headset.edit = edit


def _echo(change: Callable[[Json, np.random.Generator], Json]) -> Lie:
    def lie(headset: SimulatedHeadset, rng: np.random.Generator) -> None:
        headset.edit = _plain("probed", lambda m: [change(m, rng)])

    return lie


def _json_time(value: float) -> Lie:
    """Send a time in a report that is not a finite number."""

    def lie(headset: SimulatedHeadset, rng: np.random.Generator) -> None:
        what = str(rng.choice(["started", "time_up", "ended"]))
        name = str(rng.choice(["t_s", "active_s"]))
        headset.edit = _reports(what, lambda b: [{**b, name: value}])

    return lie


LIES: dict[str, Lie] = {
    "8 s in a moment": _too_fast,
    "more than its own clock": _slow_clock,
    "a batch ahead of time": _batch_ahead(DURATION_S - 0.01),
    "a batch far ahead of time": _batch_ahead(1e6),
    "a report before the one before": _report_backwards,
    "time that passes in a pause": _standing_gain,
    "active time that falls": _fell,
    "frames back in time": _frames_back,
    "a frame at NaN": _odd_times(lambda _: math.nan),
    "a frame at infinity": _odd_times(lambda rng: float(rng.choice([math.inf, -math.inf]))),
    "a frame beyond time": _odd_times(lambda rng: float(rng.choice([1e300, -1e12]))),
    "frames that say it stands": _idle_frames,
    "a contact backwards": _contact(
        lambda b, rng: {**b, "end_s": b["begin_s"] - rng.uniform(0.001, 9.0)}
    ),
    "a contact's active time backwards": _contact(
        lambda b, rng: {**b, "end_active_s": b["begin_active_s"] * rng.uniform(0.0, 0.9)}
    ),
    "a contact longer than it is": _contact(
        lambda b, rng: {**b, "end_active_s": b["end_active_s"] + rng.uniform(0.5, 3.0)}
    ),
    "a contact before the phase": _contact(lambda b, _: {**b, "begin_s": 0.5, "end_s": 0.6}),
    "a contact beyond the phase": _contact(
        lambda b, _: {**b, "begin_active_s": 20.0, "end_active_s": 20.1}
    ),
    "a contact at another time": _contact(
        lambda b, rng: {
            **b,
            "begin_s": b["begin_s"] + (x := rng.uniform(0.5, 3.0)),
            "end_s": b["end_s"] + x,
        }
    ),
    "a contact with box 9": _contact(lambda b, _: {**b, "box": 9}),
    "a contact of the other task": _contact(lambda b, _: {**b, "surface": "neck/1/panel"}),
    "a contact in free movement": _in_free("contact"),
    "a completion in free movement": _in_free("completion"),
    "a completion in a blink": _completion(
        lambda b, rng: {**b, "duration_s": rng.uniform(0.0, 0.15)}
    ),
    "a completion longer than it is": _completion(
        lambda b, rng: {**b, "duration_s": b["duration_s"] + rng.uniform(0.5, 9.0)}
    ),
    "a completion of too many boxes": _completion(lambda b, _: {**b, "order": [1, 2, 3, 4, 5]}),
    "a completion of one box": _completion(lambda b, _: {**b, "order": [2] * BOXES}),
    "a completion of no box": _completion(lambda b, _: {**b, "order": []}),
    "a completion before the phase": _completion(lambda b, _: {**b, "t_s": 1.0}),
    "a completion at another time": _completion(
        lambda b, rng: {**b, "active_s": b["active_s"] + rng.uniform(0.5, 3.0)}
    ),
    "a completion in the freeze": _completion_after,
    "a completion out of the count": _completion(
        lambda b, rng: {**b, "number": b["number"] + int(rng.integers(5, 9_000))}
    ),
    "completions without touches": _many_completions,
    "a walk back in a hand task": _walk_back,
    "a run that was never numbered": _given_epoch,
    "run 0": _epoch_zero,
    "more made than can be": _produced,
    "more made than can be, then the truth": _produced_then_true,
    "frames from far ahead": _seq,
    "a report from far ahead": _report_seq,
    "another server time": _echo(
        lambda m, rng: {
            **m,
            "server_sent_ns": m["server_sent_ns"] + (x := int(rng.integers(10**7, 10**12))),
            "server_received_ns": m["server_received_ns"] + x,
        }
    ),
    "an answer before the question": _echo(
        lambda m, rng: {**m, "client_received_s": m["client_sent_s"] - rng.uniform(0.001, 5.0)}
    ),
    "a report at NaN": _json_time(math.nan),
    "a report at infinity": _json_time(math.inf),
}
"""All lies by name."""
CORRECTED = ("more made than can be, then the truth",)
"""Lies that are corrected later: in the end nothing untrue is stored."""
OF_FREE = ("a contact in free movement", "a completion in free movement")
OF_HAND = tuple(name for name in LIES if "contact" in name or "complet" in name or "hand" in name)
