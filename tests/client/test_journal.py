"""Tests that the client's journal keeps messages until they are on the server's disk."""

from hypothesis import given
from hypothesis import strategies as st

from app.client.journal import Entry, Journal


def entry(stream: str, seq_end: int, epoch: int = 1, size: int = 10) -> Entry:
    """Return a message that contains ten sequence numbers."""
    return Entry(stream, epoch, seq_end, b"x" * size)


def filled(*entries: Entry) -> Journal:
    """Return a journal with these messages."""
    journal = Journal()
    for one in entries:
        journal.add(one)
    return journal


def test_messages_wait_in_order() -> None:
    """Messages are resent in the order in which they were added."""
    entries = [entry("target", 10), entry("actual", 10), entry("reports", 1)]
    journal = filled(*entries)
    assert (list(journal), len(journal), journal.waiting_bytes) == (entries, 3, 30)


def test_an_acknowledgement_removes_stored_messages() -> None:
    """An acknowledgement removes exactly the messages with `seq < next_seq`."""
    journal = filled(*(entry("target", end) for end in (10, 20, 30)))
    journal.acknowledge([("target", 1, 20)])
    assert [one.seq_end for one in journal] == [30]
    assert journal.waiting_bytes == 10


def test_a_message_stored_in_part_stays() -> None:
    """A message is kept until all of its sequence numbers are acknowledged."""
    journal = filled(entry("target", 20))
    journal.acknowledge([("target", 1, 19)])
    assert len(journal) == 1


def test_an_acknowledgement_applies_to_its_stream_and_epoch() -> None:
    """An acknowledgement removes messages of its own stream and epoch only."""
    journal = filled(entry("target", 10))
    journal.acknowledge([("actual", 1, 99), ("target", 2, 99)])
    assert len(journal) == 1


def test_an_older_acknowledgement_has_no_effect() -> None:
    """Late and duplicate acknowledgements have no effect."""
    journal = filled(entry("target", 10), entry("target", 20))
    for next_seq in (10, 5, 10):
        journal.acknowledge([("target", 1, next_seq)])
    assert [one.seq_end for one in journal] == [20]


def test_a_full_journal_reports_that_it_is_full() -> None:
    """A journal at its limit is full until an acknowledgement makes room."""
    journal = Journal(limit_bytes=20)
    journal.add(entry("target", 10))
    assert not journal.is_full
    journal.add(entry("target", 20))
    assert journal.is_full
    journal.acknowledge([("target", 1, 10)])
    assert not journal.is_full


@given(
    sizes=st.lists(st.tuples(st.sampled_from("ab"), st.integers(1, 5)), max_size=30),
    acks=st.lists(st.tuples(st.sampled_from("ab"), st.integers(0, 160)), max_size=20),
)
def test_unacknowledged_messages_are_never_removed(
    sizes: list[tuple[str, int]], acks: list[tuple[str, int]]
) -> None:
    """In any order of acknowledgements the unacknowledged messages stay and are counted."""
    journal, ends = Journal(), {"a": 0, "b": 0}
    entries = []
    for stream, count in sizes:
        ends[stream] += count
        entries.append(entry(stream, ends[stream], size=count))
        journal.add(entries[-1])
    stored = {"a": 0, "b": 0}
    for stream, next_seq in acks:
        journal.acknowledge([(stream, 1, next_seq)])
        stored[stream] = max(stored[stream], next_seq)
    waiting = [one for one in entries if one.seq_end > stored[one.stream]]
    assert [one for one in journal if one in waiting] == waiting
    assert journal.waiting_bytes == sum(len(one.message) for one in journal)
