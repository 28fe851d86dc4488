"""The laws, one by one: what they let pass and what they do not."""

from dataclasses import replace
from datetime import UTC, datetime, timedelta

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.features.record.doubts.laws import (
    KINDS,
    ClockReport,
    Completed,
    Contacts,
    Coverage,
    Doubt,
    Moment,
    PhaseClaims,
    SessionClaims,
    StreamClaim,
    doubts_about,
    exceeds_possible,
)

NOON = datetime(2026, 3, 1, 12, tzinfo=UTC)


def report(what: str, t_s: float, active_s: float, epoch: int = 1) -> ClockReport:
    """What a headset told of phase 1."""
    return ClockReport(1, epoch, what, t_s, active_s, accepted=True)


def moment(kind: str, at_s: float, active_s: float | None = None, wall_s: float = 0.0) -> Moment:
    """An event of it at so many seconds, the wall clock `wall_s` off."""
    utc = NOON + timedelta(seconds=at_s + wall_s)
    return Moment(kind, 100.0 + at_s, utc, active_s, clock_stopped=active_s is not None)


STARTED, UP, ENDED = (
    report("started", 10.0, 0.0),
    report("time_up", 70.0, 60.0),
    report("ended", 75.0, 60.0),
)
CALLED, FROZEN = moment("phase_prepared", 0.0), moment("phase_frozen", 65.0, 60.0)
PHASE = PhaseClaims(
    1,
    kind="task",
    limb="hand",
    status="done",
    active_s=60.0,
    duration_s=60.0,
    boxes=4,
    moments=(CALLED, FROZEN),
    contacts=(Contacts(1, 12.0, 69.0, 2.0, 59.0, 10.0, 10.0, 0, 0, 4, 2),),
    completed=(
        Completed(1, 1, 30.0, 20.0, 20.0, (1, 2, 3, 4)),
        Completed(1, 2, 50.0, 40.0, 20.0, (4, 3, 2, 1)),
    ),
    coverage=Coverage(5400, 60.0, 0.1, 0),
)
HONEST = SessionClaims(
    1.0,
    reports=(STARTED, UP, ENDED),
    phases=(PHASE,),
    streams=(StreamClaim("reports", 1, 9, 9, 70.0), StreamClaim("target", 1, 5400, 5400, 70.0)),
)


def doubts(**changed: object) -> list[tuple[int | None, str]]:
    """Phase and kind of what is doubted once these claims are made of the phase."""
    return named(replace(HONEST, phases=(replace(PHASE, **changed),)))  # type: ignore[arg-type]  # any claim


def named(claims: SessionClaims) -> list[tuple[int | None, str]]:
    """Phase and kind of every doubt."""
    return [(one.phase_id, one.kind) for one in doubts_about(claims)]


def with_reports(*reports: ClockReport) -> SessionClaims:
    """The session with these reports of its clock."""
    return replace(HONEST, reports=reports)


def test_an_honest_session_is_not_doubted() -> None:
    """Nothing is found where everything hangs together."""
    assert doubts_about(HONEST) == ()


def test_every_kind_that_is_found_is_explained() -> None:
    """Each doubt has words, and its kind a meaning."""
    (doubt,) = doubts_about(with_reports(STARTED, report("time_up", 11.0, 60.0)))[:1]
    assert isinstance(doubt, Doubt)
    assert (doubt.kind in KINDS, doubt.words != "") == (True, True)


@pytest.mark.parametrize(
    ("reports", "kind"),
    [
        ((STARTED, report("time_up", 11.0, 60.0)), "active_time_headset"),
        ((STARTED, report("time_up", 70.0, 60.0), report("ended", 60.0, 60.0)), "time_backwards"),
        (
            (STARTED, report("paused", 20.0, 10.0), report("resumed", 50.0, 12.0)),
            "active_time_headset",
        ),
        ((STARTED, report("paused", 20.0, 10.0), report("resumed", 50.0, 3.0)), "time_backwards"),
        ((STARTED, report("walk_back_started", 20.0, 10.0)), "walk_back"),
    ],
)
def test_a_clock_that_cannot_be_is_doubted(reports: tuple[ClockReport, ...], kind: str) -> None:
    """Active time passes with the headset's clock while it runs, and not at all while it stands."""
    assert (1, kind) in named(with_reports(*reports))


def test_a_client_that_takes_over_may_learn_how_far_the_other_had_come() -> None:
    """Until it runs itself, its active time is what the server tells it."""
    taken = (
        STARTED,
        report("paused", 3.0, 20.0, epoch=2),
        report("resumed", 9.0, 24.0, epoch=2),
        report("time_up", 45.0, 60.0, epoch=2),
    )
    assert "active_time_headset" not in {kind for _, kind in named(with_reports(*taken))}


def test_late_is_no_lie() -> None:
    """A journal that comes ten minutes later, all at once, tells what can have been."""
    late = (CALLED, moment("phase_paused", 600.0, 40.0), moment("phase_frozen", 600.1, 60.0))
    assert doubts(moments=late) == []


def test_more_time_than_passed_at_the_server_is_doubted() -> None:
    """60 s of active time cannot be over 8 s after the phase was called."""
    assert doubts(moments=(CALLED, moment("phase_frozen", 8.0, 60.0))) == [
        (1, "active_time_server")
    ]


def test_a_confirmed_pause_is_no_active_time() -> None:
    """Until the operator lets it go on the headset stands, by its own word."""
    paused = (
        CALLED,
        moment("phase_paused", 20.0, 15.0),
        moment("resume_requested", 60.0),
        moment("phase_frozen", 75.0, 60.0),
    )
    assert doubts(moments=paused) == [(1, "active_time_server")]


@pytest.mark.parametrize("wall_s", [-3600.0, 3600.0])
def test_a_wall_clock_that_is_set_accuses_nobody(wall_s: float) -> None:
    """The server's monotonic clock goes on."""
    assert doubts(moments=(CALLED, moment("phase_frozen", 65.0, 60.0, wall_s))) == []


@given(
    drift=st.floats(-1e-4, 1e-4),
    scale=st.sampled_from([0.5, 1.0, 20.0, 100.0]),
    late_s=st.floats(0.0, 600.0),
    wall_s=st.floats(-7200.0, 7200.0),
)
def test_no_honest_clock_is_doubted(
    drift: float, scale: float, late_s: float, wall_s: float
) -> None:
    """Whatever the drift, the pace of a simulated session, the delay and the wall clock."""
    real_s = 5.0 + 60.0 / (1.0 + drift) / scale + late_s
    frozen = moment("phase_frozen", real_s, 60.0, wall_s)
    phase = replace(PHASE, moments=(CALLED, frozen))
    assert named(replace(HONEST, time_scale=scale, phases=(phase,))) == []


@pytest.mark.parametrize(
    ("changed", "kind"),
    [
        ({"reversed": 1}, "contact_backwards"),
        ({"elsewhere": 1}, "contact_place"),
        ({"highest_box": 5}, "contact_place"),
        ({"last_active_s": 61.0}, "contact_time"),
        ({"first_s": 9.0}, "contact_time"),
        ({"last_s": 80.0}, "contact_time"),
        ({"offset_first_s": 5.0}, "contact_time"),
        ({"offset_last_s": 12.0}, "contact_time"),
        ({"epoch": 2}, "contact_time"),
    ],
)
def test_a_contact_that_cannot_be_is_doubted(changed: dict[str, int], kind: str) -> None:
    """It ends after it began, touches what is there, and lies in the phase's active time."""
    contacts = PHASE.contacts[0]._replace(**changed)
    assert doubts(contacts=(contacts,), completed=()) == [(1, kind)]


@pytest.mark.parametrize(
    ("changed", "kind"),
    [
        ({"order": (1, 2, 3, 4, 5)}, "completion_place"),
        ({"order": (1, 1, 2, 3)}, "completion_place"),
        ({"duration_s": 0.1}, "completion_pace"),
        ({"duration_s": 30.0}, "completion_time"),
        ({"at_s": 5.0}, "completion_time"),
        ({"at_s": 45.0}, "completion_time"),
        ({"number": 7}, "completion_count"),
    ],
)
def test_a_completion_that_cannot_be_is_doubted(changed: dict[str, int], kind: str) -> None:
    """It takes a person's time, lies in the phase's, and is of its boxes."""
    first, second = PHASE.completed
    assert (1, kind) in doubts(completed=(first, second._replace(**changed)))  # type: ignore[arg-type]  # any claim


def test_completions_need_a_task_and_its_target() -> None:
    """None in free movement, and no more than the target was touched."""
    assert doubts(kind="free_roam", boxes=0, contacts=()) == [(1, "completion_place")]
    untouched = PHASE.contacts[0]._replace(completing=0)
    assert doubts(contacts=(untouched,)) == [(1, "completion_count")]


@pytest.mark.parametrize(
    ("coverage", "kind"),
    [
        (Coverage(5400, 60.0, 0.0, 1), "time_backwards"),
        (Coverage(900, 10.0, 0.0, 0), "active_time_frames"),
        (Coverage(9000, 100.0, 0.0, 0), "active_time_frames"),
    ],
)
def test_frames_that_tell_another_time_are_doubted(coverage: Coverage, kind: str) -> None:
    """What is active is in the frames, and what is in the frames is active."""
    assert doubts(coverage=coverage) == [(1, kind)]


def test_a_gap_in_the_frames_is_no_lie() -> None:
    """Half of them lost in the middle, and a clock that was asleep in between."""
    assert doubts(coverage=Coverage(2700, 60.0, 30.0, 0)) == []
    assert doubts(coverage=Coverage(5400, 400.0, 340.0, 0)) == []


def test_runs_are_those_that_were_numbered() -> None:
    """1, 2, 3 were given one after the other; 0 and 7 never."""
    streams = [StreamClaim("reports", epoch, 1, 1, 10.0) for epoch in (0, 1, 2, 7)]
    for wrong in (0, 7):
        kept = tuple(one for one in streams if one.epoch in (1, 2, wrong))
        (found,) = doubts_about(replace(HONEST, streams=kept))
        assert (found.phase_id, found.kind, found.claimed) == (None, "epoch", wrong)


def test_a_count_is_within_reason_as_long_as_a_headset_can_have_made_it() -> None:
    """An hour of a fast headset that was offline all the time is; a million in a minute is not."""
    assert not exceeds_possible(144 * 3600, 3600.0)
    assert exceeds_possible(1_000_000, 60.0)
    assert not exceeds_possible(1_000_000, 60.0, time_scale=20.0)


def test_what_the_server_saw_itself_is_told_in_its_own_words() -> None:
    """Two observations are two doubts about the session."""
    seen = replace(HONEST, observed=("one thing", "another"))
    assert [one.words for one in doubts_about(seen)] == ["another", "one thing"]
