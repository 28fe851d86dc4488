"""Tests of counterbalancing: its laws of balance, and ledgers that grow without changing."""

from collections import Counter
from itertools import pairwise

import pytest

from app.protocol import StudyProtocol, ledger_block, sequences
from tests.protocol.helpers import loaded, problems, study, with_levels

STUDY = study()
LARGE = loaded(with_levels(4)).protocol


def williams_study(n: int) -> StudyProtocol:
    """Return the shipped study with n conditions in a Williams design."""
    return loaded(with_levels(n).replace("design: all_permutations", "design: williams")).protocol


BALANCED = {
    "3 levels": STUDY,
    "4 levels": LARGE,
    **{f"williams {n}": williams_study(n) for n in (2, 3, 4, 5, 8, 9)},
}


@pytest.mark.parametrize("protocol", BALANCED.values(), ids=BALANCED.keys())
class TestBalance:
    """The balance of every block of the ledger."""

    def test_a_block_contains_every_order_once(self, protocol: StudyProtocol) -> None:
        """A block of the ledger has every order of the design exactly once."""
        for index in range(5):
            rows = [row.sequence for row in ledger_block(protocol, index)]
            assert sorted(rows) == sorted(sequences(protocol))
            assert len(set(rows)) == len(rows)

    def test_each_condition_occurs_equally_often_at_each_position(
        self, protocol: StudyProtocol
    ) -> None:
        """In a block each condition occurs equally often at each position."""
        rows = [row.sequence for row in ledger_block(protocol, 0)]
        counts = Counter((at, key) for row in rows for at, key in enumerate(row))
        assert len(counts) == len(protocol.conditions) ** 2
        assert len(set(counts.values())) == 1

    def test_each_ordered_pair_of_neighbours_occurs_equally_often(
        self, protocol: StudyProtocol
    ) -> None:
        """In a block each ordered pair of neighbours occurs equally often.

        This balances first-order carry-over.
        """
        rows = [row.sequence for row in ledger_block(protocol, 0)]
        counts = Counter(pair for row in rows for pair in pairwise(row))
        n = len(protocol.conditions)
        assert len(counts) == n * (n - 1)
        assert len(set(counts.values())) == 1


def test_orders_are_listed_by_the_place_of_their_conditions() -> None:
    """Orders are sorted by the position of the conditions in the file, not by their keys."""
    assert sequences(STUDY)[:2] == (
        ("latency_0", "latency_125", "latency_350"),
        ("latency_0", "latency_350", "latency_125"),
    )


def test_blocks_depend_on_nothing_but_seed_and_index() -> None:
    """A ledger's block depends only on seed and index, so more blocks change no earlier ones."""
    more = study(("replicates: 2", "replicates: 9"))
    for index in range(3):
        assert ledger_block(STUDY, index) == ledger_block(more, index)
    other = study(("seed: 20200415", "seed: 7"))
    assert [ledger_block(other, n) for n in range(3)] != [ledger_block(STUDY, n) for n in range(3)]


def test_blocks_are_shuffled_differently() -> None:
    """The ledger's blocks are shuffled differently, so the next order cannot be predicted."""
    mixed = {tuple(row.sequence for row in ledger_block(STUDY, index)) for index in range(8)}
    assert len(mixed) == 8


def test_a_ledger_is_the_same_in_every_release() -> None:
    """The ledger's first rows for the shipped seed are the same in every release."""
    rows = ledger_block(STUDY, 0)
    assert rows[0] == (("latency_0", "latency_350", "latency_125"), 1)
    assert rows[5] == (("latency_0", "latency_125", "latency_350"), 1)
    assert {row.replicate for row in ledger_block(STUDY, 1)} == {2}


def test_blocks_count_from_zero() -> None:
    """A negative block index is rejected."""
    with pytest.raises(ValueError, match="count from 0"):
        ledger_block(STUDY, -1)


@pytest.mark.parametrize(("n", "rows"), [(2, 2), (3, 6), (4, 4), (5, 10), (8, 8), (9, 18)])
def test_a_williams_design_needs_few_rows(n: int, rows: int) -> None:
    """A Williams design has n rows for an even number of conditions and 2n for an odd one."""
    assert len(ledger_block(williams_study(n), 0)) == rows


def test_for_three_conditions_williams_is_all_permutations() -> None:
    """For three conditions the Williams design has all six permutations."""
    keys = [row.sequence for row in ledger_block(williams_study(3), 0)]
    assert sorted(keys) == sorted(sequences(loaded(with_levels(3)).protocol))


def explicit(*orders: str) -> str:
    """Return the shipped study with two conditions and listed orders."""
    listed = "".join(f"    - [{order}]\n" for order in orders)
    return with_levels(2).replace(
        "design: all_permutations\n", f"design: explicit\n  sequences:\n{listed}"
    )


def test_listed_orders_are_used_as_they_are() -> None:
    """Each listed order occurs once in a block, shuffled by the seed."""
    protocol = loaded(explicit("c1, c0")).protocol
    assert [row.sequence for row in ledger_block(protocol, 1)] == [("c1", "c0")]


@pytest.mark.parametrize(
    ("text", "path", "expected_message"),
    [
        (explicit("c0, c0"), "orders.sequences[0]", "every condition once"),
        (explicit("c0, c1", "c0"), "orders.sequences[1]", "every condition once"),
        (explicit("c0, c1", "c0, c1"), "orders.sequences[1]", "twice"),
        (explicit("c0, c1").replace("explicit", "williams"), "orders.sequences", "only for that"),
        (
            with_levels(2).replace("all_permutations", "explicit"),
            "orders.sequences",
            "only for that",
        ),
    ],
)
def test_an_invalid_list_of_orders_is_rejected_at_its_place(
    text: str, path: str, expected_message: str
) -> None:
    """Missing, repeated and superfluous orders raise an error that names their path."""
    found = [one for one in problems(text) if one.path == path]
    assert found
    assert expected_message in found[0].message


def test_the_hash_of_a_study_without_a_list_stays() -> None:
    """Studies without listed orders have no such key in their content, so the hash stays."""
    assert "sequences" not in loaded().canonical_json
