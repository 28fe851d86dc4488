"""Counterbalancing: the orders of the conditions, and the rows of the ledger that contain them.

All n! orders together are balanced by construction, and so are the few of a Williams design: each
condition is equally often at each position, and each ordered pair of neighbours occurs equally
often. The balance of an explicit list is up to its author. A *block* of the ledger contains every
order once; its rows are shuffled, so that nobody can predict the next order. Blocks are drawn
independently from the study's seed: adding one never changes existing ones.

Balance is meant as by Williams 1949, Aust. J. Sci. Res. A 2:149.
"""

from collections import Counter
from itertools import pairwise, permutations, product
from typing import NamedTuple

import numpy as np

from app.protocol.study import StudyProtocol
from app.science.williams import williams

Sequence = tuple[str, ...]
"""One order of the conditions, by their keys."""


class LedgerRow(NamedTuple):
    """One slot of the ledger: an order, and the number of its replicate (from 1)."""

    sequence: Sequence
    replicate: int


def sequences(protocol: StudyProtocol) -> tuple[Sequence, ...]:
    """Return every order of the study's design; permutations follow the conditions' file order."""
    keys = [condition.key for condition in protocol.conditions]
    match protocol.orders.design:
        case "all_permutations":
            return tuple(permutations(keys))
        case "williams":
            return tuple(tuple(keys[at] for at in row) for row in williams(len(keys)))
        case "explicit":
            return protocol.orders.sequences or ()


def ledger_block(protocol: StudyProtocol, block_index: int) -> tuple[LedgerRow, ...]:
    """Return the rows of one block, in the order in which they are assigned.

    `block_index` counts from 0 and is the replicate minus one. The rows depend only on the
    conditions' keys, the seed and the index (PCG64 seeded with SeedSequence([seed, block_index])).
    Raises ValueError for a negative index.
    """
    if block_index < 0:
        raise ValueError(f"Block {block_index} does not exist. Blocks count from 0.")
    orders = sequences(protocol)
    seeds = np.random.SeedSequence([protocol.orders.seed, block_index])
    rng = np.random.Generator(np.random.PCG64(seeds))
    return tuple(LedgerRow(orders[at], block_index + 1) for at in rng.permutation(len(orders)))


def position_counts(orders: tuple[Sequence, ...]) -> dict[str, tuple[int, ...]]:
    """Return for each condition how often it is first, second, and so on."""
    counts = Counter((key, at) for order in orders for at, key in enumerate(order))
    places = range(len(orders[0]))
    return {key: tuple(counts[key, at] for at in places) for key in sorted(orders[0])}


def neighbour_counts(orders: tuple[Sequence, ...]) -> dict[tuple[str, str], int]:
    """Return how often each condition (second) directly follows each other one (first)."""
    counts = Counter(pair for order in orders for pair in pairwise(order))
    keys = sorted(orders[0])
    return {pair: counts[pair] for pair in product(keys, keys) if pair[0] != pair[1]}


def imbalances(orders: tuple[Sequence, ...]) -> list[str]:
    """Return what is not balanced, as sentences; nothing for balanced orders."""
    found = []
    uneven = {key: one for key, one in position_counts(orders).items() if len(set(one)) > 1}
    if uneven:
        key, counts = max(uneven.items(), key=lambda one: max(one[1]) - min(one[1]))
        each = ", ".join(
            f"{count} time{'' if count == 1 else 's'} at position {at}"
            for at, count in enumerate(counts, start=1)
        )
        found.append(f"{key} comes {each}")
    pairs = neighbour_counts(orders)
    if len(set(pairs.values())) > 1:
        most, least = max(pairs, key=lambda one: pairs[one]), min(pairs, key=lambda one: pairs[one])
        found.append(
            f"{most[1]} follows {most[0]} {pairs[most]} times, {least[1]} follows {least[0]} "
            f"{pairs[least]} times"
        )
    return found
