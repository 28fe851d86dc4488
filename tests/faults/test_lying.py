"""Tests that impossible data from a headset are always noticed, and correct data never doubted."""

from collections import Counter
from collections.abc import Iterator
from datetime import datetime
from pathlib import Path

import pytest
from sqlalchemy import select

from app.features.record.alarms import open_rows
from app.features.record.doubts import doubts_of
from app.features.record.headset.service import welcome
from app.features.record.receipts import receipt_of
from app.features.record.telemetry import Summariser, assign_epoch
from app.features.record.telemetry.summaries import SUMMARIES
from app.features.results.analysis.tables import phases_table
from app.models import TelemetryStream
from app.wire import MAX_EPOCH, Hello
from tests.faults.figures import note
from tests.faults.lying_streams import CORRECTED, HAND, LIES, Outcome, play
from tests.faults.short_study import KEY, short_study
from tests.faults.simulated_headset import DURATION_S, FREEZE_S, ROAM_S
from tests.faults.simulated_site import Site
from tests.support.sqlite import fresh_sqlite

HONEST, LYING = 12, len(LIES) - len(CORRECTED)
MANY_HONEST, MANY_LYING = 300, 1000


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Site]:
    """Provide an application in simulated time."""
    folder: Path = tmp_path_factory.mktemp("lying")
    text = short_study(phase_s=DURATION_S, roam_s=ROAM_S, around_s=FREEZE_S)
    site = Site.open(fresh_sqlite(folder / "reembody.sqlite"), folder, text, KEY)
    yield site
    site.context.database.close()


def lying(site: Site, count: int) -> list[Outcome]:
    """Run `count` streams with each lie in turn."""
    names = [name for name in LIES if name not in CORRECTED]
    return [play(site, seed, names[seed % len(names)]) for seed in range(count)]


def honest(site: Site, count: int) -> list[Outcome]:
    """Run `count` correct streams."""
    return [play(site, 1_000_000 + seed) for seed in range(count)]


def tell(outcomes: list[Outcome], what: str) -> list[str]:
    """Report the figures of the streams and return every stream with an unexpected outcome."""
    lies = what == "lying"
    wrong = [
        f"{one.seed} {one.lie}: {one.status} {one.refusals} {[d.words for d in one.doubts]}"
        for one in outcomes
        if (one.believed if lies else one.refusals or one.doubts or one.status != "done")
    ]
    note(19, f"{len(outcomes)} {what} streams", "believed" if lies else "flagged", len(wrong))
    refused = sum(bool(one.refusals) for one in outcomes)
    note(19, f"{len(outcomes)} {what} streams", "refused at once", refused)
    return wrong


def test_no_lie_is_believed(site: Site) -> None:
    """Every impossible report is rejected, or stored with a doubt."""
    assert tell(lying(site, LYING), "lying") == []


def test_no_honest_headset_is_doubted(site: Site) -> None:
    """Jitter, drift, late journals, reconnects, pauses and clock steps raise no doubt."""
    assert tell(honest(site, HONEST), "honest") == []


def test_a_doubt_is_on_the_receipt_and_raises_an_alarm(site: Site) -> None:
    """A doubt is named on the receipt, invalidates the phase and raises an alarm that names it."""
    told = play(site, 1, "8 s in a moment")
    Summariser(site.context)._run(told.session_id, 1, tuple(SUMMARIES))
    with site.context.database.reading() as db:
        receipt = receipt_of(db, told.session_id)
        alarms = {row.code: row.message for row in open_rows(db, told.session_id)}
        phases = phases_table(db, KEY, "all").set_index("session_id")
    assert [one.kind for one in receipt.doubts] == ["active_time_server"]
    assert not receipt.complete
    assert any(one.startswith("phase 1: cannot be true: 8.00 s") for one in receipt.problems)
    assert alarms["doubtful"].startswith("phase 1 does not count: 8.00 s of active time")
    row = phases.loc[told.session_id]
    assert (row["status"], bool(row["valid"])) == ("done", False)


def test_a_wrong_count_is_corrected_by_a_later_true_one(site: Site) -> None:
    """An impossibly high frame count is corrected by a later true one, and no frame is missing."""
    told = play(site, 3, "more made than can be, then the truth")
    with site.context.database.reading() as db:
        receipt = receipt_of(db, told.session_id)
        produced = {
            row.produced
            for row in db.scalars(
                select(TelemetryStream).where(TelemetryStream.session_id == told.session_id)
            )
            if row.stream != "reports"
        }
    assert (told.doubts, told.status) == ((), "done")
    assert produced == {one.stored for one in receipt.streams if one.stream == "target"}
    assert all(one.missing == 0 for one in receipt.streams)


def test_the_highest_epoch_does_not_block_later_runs(site: Site) -> None:
    """After a client claimed the highest epoch, later runs get unused epochs."""
    session_id = site.join(step=HAND)
    with site.context.database.writing() as db:
        now = site.context.clock.utc_now()
        hello = Hello(protocol=1, client="liar", epoch=MAX_EPOCH)
        assert welcome(db, session_id, hello, now).epoch == MAX_EPOCH
        db.add(stream_row(session_id, MAX_EPOCH, now))
        epochs = [assign_epoch(db, session_id, now) for _ in range(3)]
    assert epochs == [1, 2, 3]
    with site.context.database.reading() as db:
        assert {one.kind for one in doubts_of(db, session_id)} == {"epoch", "observed"}


def test_a_run_that_comes_back_with_other_abilities_is_recorded(site: Site) -> None:
    """A reconnecting run that lost or gained an ability puts the session in doubt; a same one not.

    What a run records follows from its abilities, so that two clients share one epoch there.
    """
    session_id = site.join(step=HAND)
    now = site.context.clock.utc_now()
    with site.context.database.writing() as db:
        told = Hello(protocol=1, client="headset", fingers=True, goals=True)
        epoch = welcome(db, session_id, told, now).epoch
        welcome(db, session_id, told.model_copy(update={"epoch": epoch}), now)
    with site.context.database.reading() as db:
        assert not doubts_of(db, session_id)
    with site.context.database.writing() as db:
        other = Hello(protocol=1, client="headset", fingers=True, panels=True, epoch=epoch)
        welcome(db, session_id, other, now)
    with site.context.database.reading() as db:
        (doubt,) = doubts_of(db, session_id)
    assert "came back with other abilities: without goals, with panels" in doubt.words


def test_a_client_that_takes_over_gets_no_impossible_active_time(site: Site) -> None:
    """A client that takes over is not given the impossible active time of an earlier batch."""
    told = play(site, 4, "a batch far ahead of time")
    assert told.believed is False
    orders = [one["state"]["phase"]["active_s"] for one in told.welcomes if one["state"]["phase"]]
    assert orders == [DURATION_S]


def stream_row(session_id: str, epoch: int, now: datetime) -> TelemetryStream:
    """Return the database row of a stream that received one report."""
    return TelemetryStream(
        session_id=session_id,
        stream="reports",
        epoch=epoch,
        next_seq=1,
        frames_stored=1,
        first_at=now,
        last_at=now,
    )


@pytest.mark.long
@pytest.mark.timeout(3600)
def test_none_of_a_thousand_lies_is_believed(site: Site) -> None:
    """A thousand impossible streams are all rejected or doubted, and 300 correct ones are not."""
    told = lying(site, MANY_LYING)
    assert tell(told, "lying") == []
    kinds = Counter(doubt.kind for one in told for doubt in one.doubts)
    note(19, "doubts by kind", "streams", dict(kinds))
    assert tell(honest(site, MANY_HONEST), "honest") == []
