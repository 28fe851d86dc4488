"""The client's journal: nothing leaves it before it is on the server's disk."""

from hypothesis import given
from hypothesis import strategies as st

from app.client.journal import Entry, Journal


def entry(stream: str, seq_end: int, epoch: int = 1, size: int = 10) -> Entry:
    """A message that carries ten seqs."""
    return Entry(stream, epoch, seq_end, b"x" * size)


def filled(*entries: Entry) -> Journal:
    """A journal with these messages."""
    journal = Journal()
    for one in entries:
        journal.add(one)
    return journal


def test_messages_wait_in_order() -> None:
    """What is sent again is sent in the order it was made."""
    entries = [entry("target", 10), entry("actual", 10), entry("reports", 1)]
    journal = filled(*entries)
    assert (list(journal), len(journal), journal.waiting_bytes) == (entries, 3, 30)


def test_an_acknowledgement_lets_go_of_what_is_stored() -> None:
    """All of `seq < next_seq` leaves, nothing else."""
    journal = filled(*(entry("target", end) for end in (10, 20, 30)))
    journal.acknowledge([("target", 1, 20)])
    assert [one.seq_end for one in journal] == [30]
    assert journal.waiting_bytes == 10


def test_a_message_stored_in_part_stays() -> None:
    """Only a message whose every seq is stored may go."""
    journal = filled(entry("target", 20))
    journal.acknowledge([("target", 1, 19)])
    assert len(journal) == 1


def test_another_stream_or_run_is_not_meant() -> None:
    """An acknowledgement counts for its own stream and epoch."""
    journal = filled(entry("target", 10))
    journal.acknowledge([("actual", 1, 99), ("target", 2, 99)])
    assert len(journal) == 1


def test_an_older_acknowledgement_takes_nothing_back() -> None:
    """Acknowledgements may come late and twice."""
    journal = filled(entry("target", 10), entry("target", 20))
    for next_seq in (10, 5, 10):
        journal.acknowledge([("target", 1, next_seq)])
    assert [one.seq_end for one in journal] == [20]


def test_a_full_journal_says_so() -> None:
    """The producer has to wait from the limit on, and may go on after an acknowledgement."""
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
def test_nothing_unacknowledged_ever_leaves(
    sizes: list[tuple[str, int]], acks: list[tuple[str, int]]
) -> None:
    """Whatever is acknowledged in whatever order, the rest is still there, counted right."""
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
