"""Describe how conditions were ordered over participants, and whether the orders are balanced.

What matters is balance, not which orders were drawn: every condition equally often at every
position, and every ordered pair of conditions equally often as neighbours. `app.science.williams`
generates the smallest sets of orders with both properties.
"""

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise, permutations

from app.science.statistics.mixed.terms import Label
from app.science.williams import williams

Order = tuple[str, ...]


@dataclass(frozen=True)
class Orders:
    """The orders of a study's participants.

    Attributes:
        counts: how many participants had each complete order.
        incomplete: participants who lack a period; they are not in the counts below.
        positions: for each condition, how often it was first, second, ...
        neighbours: for each pair (condition, next condition), how often it occurred.
        balanced_positions, balanced_neighbours: whether all of these counts are equal.
        missing: orders of the Williams design that no participant had; empty if there are orders
            outside the design.
    """

    counts: tuple[tuple[Order, int], ...]
    incomplete: int
    positions: tuple[tuple[str, tuple[int, ...]], ...]
    neighbours: tuple[tuple[tuple[str, str], int], ...]
    balanced_positions: bool
    balanced_neighbours: bool
    missing: tuple[Order, ...]

    @property
    def balanced(self) -> bool:
        """Whether positions and neighbours are balanced and no participant is incomplete."""
        return self.balanced_positions and self.balanced_neighbours and not self.incomplete


def describe_orders(placed: Mapping[tuple[Label, int], str], levels: tuple[str, ...]) -> Orders:
    """Describe the orders of the participants.

    Args:
        placed: the condition of each participant in each period, which counts from 1.
        levels: all conditions.
    """
    last = max(period for _, period in placed)
    people = dict.fromkeys(who for who, _ in placed)
    orders = [tuple(placed.get((who, at), "") for at in range(1, last + 1)) for who in people]
    complete = [order for order in orders if "" not in order]
    positions = {
        level: tuple(sum(order[at] == level for order in complete) for at in range(last))
        for level in levels
    }
    followed = Counter(pair for order in complete for pair in pairwise(order))
    neighbours = {pair: followed[pair] for pair in permutations(levels, 2)}
    design = [tuple(levels[at] for at in row) for row in williams(len(levels))]
    drawn_from_design = all(order in design for order in complete)
    return Orders(
        counts=tuple(sorted(Counter(complete).items())),
        incomplete=len(orders) - len(complete),
        positions=tuple(positions.items()),
        neighbours=tuple(neighbours.items()),
        balanced_positions=len({count for row in positions.values() for count in row}) == 1,
        balanced_neighbours=len(set(neighbours.values())) == 1 and not _repeats(complete),
        missing=tuple(order for order in design if order not in complete)
        if drawn_from_design
        else (),
    )


def _repeats(orders: list[Order]) -> bool:
    return any(first == second for order in orders for first, second in pairwise(order))
