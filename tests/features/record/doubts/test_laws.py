"""Tests of each law about a headset's reports: what it accepts and what it doubts."""

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
    Stature,
    StreamClaim,
    doubts_about,
    exceeds_possible,
)

NOON = datetime(2026, 3, 1, 12, tzinfo=UTC)


def report(what: str, t_s: float, active_s: float, epoch: int = 1) -> ClockReport:
    """Return a headset's report about the clock of phase 1."""
    return ClockReport(1, epoch, what, t_s, active_s, accepted=True)


def moment(kind: str, at_s: float, active_s: float | None = None, wall_s: float = 0.0) -> Moment:
    """Return an event of the phase, `at_s` seconds in, with a wall clock that is `wall_s` off."""
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
    """Return (phase, kind) of each doubt about a session whose phase has these claims."""
    return named(replace(HONEST, phases=(replace(PHASE, **changed),)))  # type: ignore[arg-type]  # any claim


def named(claims: SessionClaims) -> list[tuple[int | None, str]]:
    """Return (phase, kind) of each doubt about these claims."""
    return [(one.phase_id, one.kind) for one in doubts_about(claims)]


def with_reports(*reports: ClockReport) -> SessionClaims:
    """Return the consistent session with these reports of its clock instead."""
    return replace(HONEST, reports=reports)


def test_a_consistent_session_raises_no_doubt() -> None:
    """A session whose claims are consistent raises no doubt."""
    assert doubts_about(HONEST) == ()


def test_every_doubt_has_a_message_and_a_documented_kind() -> None:
    """A doubt has a message, and its kind is documented."""
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
def test_an_impossible_clock_is_doubted(reports: tuple[ClockReport, ...], kind: str) -> None:
    """Active time that does not pass with the headset's running clock is doubted."""
    assert (1, kind) in named(with_reports(*reports))


def test_a_new_client_may_continue_from_the_servers_active_time() -> None:
    """A client that takes over a paused phase may continue from the server's active time."""
    taken = (
        STARTED,
        report("paused", 3.0, 20.0, epoch=2),
        report("resumed", 9.0, 24.0, epoch=2),
        report("time_up", 45.0, 60.0, epoch=2),
    )
    assert "active_time_headset" not in {kind for _, kind in named(with_reports(*taken))}


def test_a_late_journal_is_not_doubted() -> None:
    """Reports that arrive ten minutes late and all together are not doubted."""
    late = (CALLED, moment("phase_paused", 600.0, 40.0), moment("phase_frozen", 600.1, 60.0))
    assert doubts(moments=late) == []


def test_more_time_than_passed_at_the_server_is_doubted() -> None:
    """60 s of active time, 8 s after the phase was prepared, are doubted."""
    assert doubts(moments=(CALLED, moment("phase_frozen", 8.0, 60.0))) == [
        (1, "active_time_server")
    ]


def test_time_in_a_confirmed_pause_is_not_active_time() -> None:
    """Active time claimed for a pause that the headset confirmed is doubted."""
    paused = (
        CALLED,
        moment("phase_paused", 20.0, 15.0),
        moment("resume_requested", 60.0),
        moment("phase_frozen", 75.0, 60.0),
    )
    assert doubts(moments=paused) == [(1, "active_time_server")]


@pytest.mark.parametrize("wall_s", [-3600.0, 3600.0])
def test_a_wall_clock_change_is_not_doubted(wall_s: float) -> None:
    """A change of the server's wall clock raises no doubt, as its monotonic clock continues."""
    assert doubts(moments=(CALLED, moment("phase_frozen", 65.0, 60.0, wall_s))) == []


@given(
    drift=st.floats(-1e-4, 1e-4),
    scale=st.sampled_from([0.5, 1.0, 20.0, 100.0]),
    late_s=st.floats(0.0, 600.0),
    wall_s=st.floats(-7200.0, 7200.0),
)
def test_a_correct_clock_is_never_doubted(
    drift: float, scale: float, late_s: float, wall_s: float
) -> None:
    """A correct clock raises no doubt, whatever its drift, time scale, delay and wall clock."""
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
def test_an_impossible_contact_is_doubted(changed: dict[str, int], kind: str) -> None:
    """A contact with reversed times, an unknown surface or a time outside the phase is doubted."""
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
def test_an_impossible_completed_task_is_doubted(changed: dict[str, int], kind: str) -> None:
    """A completed task that is too fast, outside the phase or of unknown boxes is doubted."""
    first, second = PHASE.completed
    assert (1, kind) in doubts(completed=(first, second._replace(**changed)))  # type: ignore[arg-type]  # any claim


def test_completed_tasks_need_a_task_phase_and_its_target() -> None:
    """Completed tasks are doubted in free movement, or if they outnumber touches of the target."""
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
def test_active_time_that_disagrees_with_the_frames_is_doubted(
    coverage: Coverage, kind: str
) -> None:
    """Active time that disagrees with the time covered by frames is doubted."""
    assert doubts(coverage=coverage) == [(1, kind)]


def test_a_gap_in_the_frames_is_not_doubted() -> None:
    """Lost frames, and a clock that was suspended, raise no doubt."""
    assert doubts(coverage=Coverage(2700, 60.0, 30.0, 0)) == []
    assert doubts(coverage=Coverage(5400, 400.0, 340.0, 0)) == []


def test_an_epoch_that_was_not_assigned_is_doubted() -> None:
    """An epoch that the server did not assign is doubted."""
    streams = [StreamClaim("reports", epoch, 1, 1, 10.0) for epoch in (0, 1, 2, 7)]
    for wrong in (0, 7):
        kept = tuple(one for one in streams if one.epoch in (1, 2, wrong))
        (found,) = doubts_about(replace(HONEST, streams=kept))
        assert (found.phase_id, found.kind, found.claimed) == (None, "epoch", wrong)


def test_a_frame_count_is_possible_if_a_headset_can_make_it() -> None:
    """A frame count is possible if a fast headset could have made it in the elapsed time."""
    assert not exceeds_possible(144 * 3600, 3600.0)
    assert exceeds_possible(1_000_000, 60.0)
    assert not exceeds_possible(1_000_000, 60.0, time_scale=20.0)


def test_the_servers_own_observations_become_doubts() -> None:
    """Each observation by the server itself becomes a doubt with its message."""
    seen = replace(HONEST, observed=("one thing", "another"))
    assert [one.words for one in doubts_about(seen)] == ["another", "one thing"]


@pytest.mark.parametrize(
    ("worn_m", "status", "doubted"),
    [(1.6, "done", False), (1.56, "done", True), (0.6, "done", True), (0.6, "voided", False)],
)
def test_bodies_are_worn_at_the_participants_stature(
    *, worn_m: float, status: str, doubted: bool
) -> None:
    """Statures of one phase are one person's to 15 cm; a phase that was repeated does not count.

    The doubt is about the session: a phase's number could tell which body was worn.
    """
    statures = (
        Stature("the participant", 1.75),
        Stature("the calibration", 1.72),
        Stature("a body that was worn", worn_m),
    )
    claims = replace(HONEST, phases=(replace(PHASE, statures=statures, status=status),))
    found = [one for one in doubts_about(claims) if one.kind == "stature"]
    assert [one.phase_id for one in found] == [None] * doubted
    assert all(f"{worn_m:.2f} m" in one.words for one in found)
