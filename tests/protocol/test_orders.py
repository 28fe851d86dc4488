"""Counterbalancing: the balance laws, and that a ledger can grow without changing."""

from collections import Counter
from itertools import pairwise

import pytest

from app.protocol import StudyProtocol, ledger_block, sequences
from tests.protocol.helpers import loaded, study, with_levels

STUDY = study()
LARGE = loaded(with_levels(4)).protocol


@pytest.mark.parametrize("protocol", [STUDY, LARGE], ids=["3 levels", "4 levels"])
class TestBalance:
    """What a block of the ledger promises, whatever its index."""

    def test_a_block_holds_every_order_once(self, protocol: StudyProtocol) -> None:
        """n conditions make n! rows, all different."""
        for index in range(5):
            rows = [row.sequence for row in ledger_block(protocol, index)]
            assert sorted(rows) == sorted(sequences(protocol))
            assert len(set(rows)) == len(rows)

    def test_each_condition_stands_equally_often_at_each_position(
        self, protocol: StudyProtocol
    ) -> None:
        """No level profits from coming late."""
        rows = [row.sequence for row in ledger_block(protocol, 0)]
        counts = Counter((at, key) for row in rows for at, key in enumerate(row))
        assert len(counts) == len(protocol.conditions) ** 2
        assert len(set(counts.values())) == 1

    def test_each_ordered_pair_of_neighbours_occurs_equally_often(
        self, protocol: StudyProtocol
    ) -> None:
        """First-order carry-over is balanced."""
        rows = [row.sequence for row in ledger_block(protocol, 0)]
        counts = Counter(pair for row in rows for pair in pairwise(row))
        n = len(protocol.conditions)
        assert len(counts) == n * (n - 1)
        assert len(set(counts.values())) == 1


def test_orders_are_listed_by_the_place_of_their_conditions() -> None:
    """Lexicographic in the file's own order, whatever the keys are called."""
    assert sequences(STUDY)[:2] == (
        ("latency_0", "latency_125", "latency_350"),
        ("latency_0", "latency_350", "latency_125"),
    )


def test_blocks_depend_on_nothing_but_seed_and_index() -> None:
    """Adding a block never changes those that exist."""
    more = study(("replicates: 2", "replicates: 9"))
    for index in range(3):
        assert ledger_block(STUDY, index) == ledger_block(more, index)
    other = study(("seed: 20200415", "seed: 7"))
    assert [ledger_block(other, n) for n in range(3)] != [ledger_block(STUDY, n) for n in range(3)]


def test_blocks_are_mixed_differently() -> None:
    """Nobody can tell the next order from the last block."""
    mixed = {tuple(row.sequence for row in ledger_block(STUDY, index)) for index in range(8)}
    assert len(mixed) == 8


def test_a_ledger_is_the_same_in_every_release() -> None:
    """The first rows for the shipped seed, as drawn when it was written."""
    rows = ledger_block(STUDY, 0)
    assert rows[0] == (("latency_0", "latency_350", "latency_125"), 1)
    assert rows[5] == (("latency_0", "latency_125", "latency_350"), 1)
    assert {row.replicate for row in ledger_block(STUDY, 1)} == {2}


def test_blocks_count_from_zero() -> None:
    """There is no block before the first."""
    with pytest.raises(ValueError, match="count from 0"):
        ledger_block(STUDY, -1)
