"""Tests that messages added to a journal in files survive any end of the process."""

import resource
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.client.file_journal import SUFFIX, FileJournal
from app.client.journal import Entry, Journal

MESSAGES = st.one_of(st.binary(max_size=40), st.text(max_size=40))


@given(
    messages=st.lists(MESSAGES, max_size=30),
    acked=st.integers(0, 30),
    memory_bytes=st.integers(0, 200),
    segment_bytes=st.integers(20, 400),
)
@settings(max_examples=60, deadline=None)
def test_it_contains_what_a_journal_in_memory_contains(
    tmp_path_factory: pytest.TempPathFactory,
    messages: list[bytes | str],
    acked: int,
    memory_bytes: int,
    segment_bytes: int,
) -> None:
    """A journal in files has the same messages as one in memory, also after reopening."""
    folder = tmp_path_factory.mktemp("journal")
    model = Journal()
    filed = FileJournal(folder=folder, memory_bytes=memory_bytes, segment_bytes=segment_bytes)
    for at, message in enumerate(messages):
        for journal in (model, filed):
            journal.add(Entry("target", 3, at + 1, message))
    for journal in (model, filed):
        journal.acknowledge([("target", 3, acked)])
    assert (list(filed), len(filed)) == (list(model), len(model))
    filed.close()
    reopened = FileJournal(folder=folder, segment_bytes=segment_bytes)
    reopened.acknowledge([("target", 3, acked)])
    assert list(reopened) == list(model)
    if not len(model):
        assert reopened.waiting_bytes == 0


def test_acknowledged_segments_are_deleted(tmp_path: Path) -> None:
    """A segment file is deleted once all of its messages are acknowledged."""
    journal = FileJournal(folder=tmp_path, segment_bytes=1000)
    for at in range(100):
        journal.add(Entry("target", 1, at + 1, b"x" * 100))
    assert len(list(tmp_path.iterdir())) > 5
    journal.acknowledge([("target", 1, 95)])
    assert len(list(tmp_path.iterdir())) <= 2
    journal.acknowledge([("target", 1, 100)])
    assert list(tmp_path.iterdir()) == []
    journal.add(Entry("target", 1, 101, b"more"))
    journal.close()
    assert [one.seq_end for one in FileJournal(folder=tmp_path)] == [101]


def test_a_torn_record_is_left_out(tmp_path: Path) -> None:
    """A record that the end of the process cut off is left out when the journal is reopened."""
    journal = FileJournal(folder=tmp_path)
    for at in range(3):
        journal.add(Entry("target", 1, at + 1, b"x" * 100))
    journal.close()
    (segment,) = tmp_path.glob(f"*{SUFFIX}")
    segment.write_bytes(segment.read_bytes()[:-50])
    assert [one.seq_end for one in FileJournal(folder=tmp_path)] == [1, 2]


def test_a_new_process_appends_to_the_old_segments(tmp_path: Path) -> None:
    """Messages of a journal in files stay in order over any number of reopenings."""
    for at in range(4):
        journal = FileJournal(folder=tmp_path)
        journal.add(Entry("target", at + 1, 1, b"%d" % at))
        journal.close()
    assert [one.message for one in FileJournal(folder=tmp_path)] == [b"0", b"1", b"2", b"3"]


def test_a_full_disk_leaves_no_partial_record(tmp_path: Path) -> None:
    """A message that does not fit on the disk is rejected whole; the others are kept."""
    journal = FileJournal(folder=tmp_path)
    journal.add(Entry("target", 1, 1, b"x" * 100))
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    handler = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    try:
        resource.setrlimit(resource.RLIMIT_FSIZE, (200, before[1]))
        with pytest.raises(OSError, match=r"no space|too large"):
            journal.add(Entry("target", 1, 2, b"y" * 1000))
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
        signal.signal(signal.SIGXFSZ, handler)
    journal.add(Entry("target", 1, 2, b"z" * 1000))
    journal.close()
    assert [one.message[:1] for one in FileJournal(folder=tmp_path)] == [b"x", b"z"]


def test_a_killed_process_leaves_everything_it_added(tmp_path: Path) -> None:
    """After SIGKILL the journal still has every message for which `add` had returned."""
    work = (
        "import sys; from pathlib import Path\n"
        "from app.client.file_journal import FileJournal\n"
        "from app.client.journal import Entry\n"
        "journal = FileJournal(folder=Path(sys.argv[1]))\n"
        "for at in range(10**9):\n"
        "    journal.add(Entry('target', 1, at + 1, b'x' * 2000))\n"
        "    print(at + 1, flush=True)\n"
    )
    process = subprocess.Popen(
        [sys.executable, "-c", work, str(tmp_path)], stdout=subprocess.PIPE, text=True
    )
    assert process.stdout is not None
    added = [int(process.stdout.readline()) for _ in range(500)]
    process.kill()
    added += [int(line) for line in process.stdout.read().split("\n")[:-1]]
    process.wait()
    process.stdout.close()
    found = [one.seq_end for one in FileJournal(folder=tmp_path)]
    assert found[: len(added)] == added
    assert len(found) - len(added) in (0, 1)
