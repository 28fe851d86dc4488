"""Tests that every design stays balanced with simultaneous joins and with dropouts.

The short form has a hundred joins for the design with the most orders and forty for each of the
others, which is at least four times the number of its orders and leaves the same remainder as a
hundred. The database does not depend on the design, so PostgreSQL, whose locks differ, is tested
with one design.
"""

from collections import Counter
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from itertools import pairwise
from pathlib import Path

import pytest
from httpx2 import Client

from tests.features.lab import Json, ok
from tests.protocol.helpers import with_levels
from tests.support.server import ADMIN_PASSWORD, LiveServer

JOINS, DROPOUTS, AT_ONCE = 100, 24, 20
FEW_JOINS, FEW_DROPOUTS = 40, 10
MOST_ORDERS = "all permutations of 4"
ON_POSTGRESQL = "Williams, 5 conditions"
LISTED = """design: explicit
  sequences:
    - [c0, c1, c2, c3]
    - [c1, c3, c0, c2]
    - [c3, c2, c1, c0]
"""
SCHEMES: dict[str, tuple[int, str, int]] = {
    "all permutations of 3": (3, "", 6),
    "all permutations of 4": (4, "", 24),
    "Williams, 4 conditions": (4, "design: williams\n", 4),
    "Williams, 5 conditions": (5, "design: williams\n", 10),
    "explicit list of 3": (4, LISTED, 3),
}
"""Name -> conditions, the design in the file, and how many orders it has."""


def study(name: str) -> tuple[str, str]:
    """Return the key and text of a study with that design, in three replicates."""
    levels, design, _ = SCHEMES[name]
    key = "scheme-" + "".join(letter for letter in name.lower() if letter.isalnum())
    text = with_levels(levels).replace("key: reembodiment-latency", f"key: {key}", 1)
    if design:
        text = text.replace("design: all_permutations\n", design, 1)
    return key, text.replace("replicates: 2", "replicates: 3", 1)


@pytest.fixture
def client(database_url: str, tmp_path: Path) -> Iterator[Client]:
    """Yield a signed-in client of a real server, on each engine."""
    environment = {"REEMBODY_DATABASE_URL": database_url}
    with LiveServer(tmp_path, environment=environment) as server, server.client() as signed_in:
        ok(signed_in.post("/api/login", json={"username": "admin", "password": ADMIN_PASSWORD}))
        yield signed_in


def run_concurrently(task: Callable[[Json], Json], wishes: list[Json]) -> list[Json]:
    """Run a task for each of the items, twenty at a time."""
    with ThreadPoolExecutor(AT_ONCE) as pool:
        return list(pool.map(task, wishes))


def imbalance(sequences: list[list[float]], orders: int) -> int:
    """Return the difference between the most and the least frequent order."""
    counts = Counter(map(tuple, sequences))
    assert len(counts) <= orders
    return max(counts.values()) - (min(counts.values()) if len(counts) == orders else 0)


@pytest.mark.parametrize("many", [False, pytest.param(True, marks=pytest.mark.long)])
def test_every_scheme_stays_balanced(
    client: Client,
    database_url: str,
    many: bool,  # noqa: FBT001 - by name
) -> None:
    """In every design the most frequent order leads by at most one, before and after dropouts.

    A slot that was given back is taken again, and none is taken twice.
    """
    both = many or database_url.startswith("sqlite")
    for name in SCHEMES if both else [ON_POSTGRESQL]:
        levels, _, orders = SCHEMES[name]
        key, text = study(name)
        all_join = many or name == MOST_ORDERS
        joins, dropouts = (JOINS, DROPOUTS) if all_join else (FEW_JOINS, FEW_DROPOUTS)
        ok(client.post("/api/studies", json={"yaml": text}))

        def join(_: Json, key: str = key) -> Json:
            view: Json = ok(client.post(f"/api/studies/{key}/sessions", json={}))
            return view

        views = run_concurrently(join, [{}] * joins)
        joined = imbalance([view["sequence"] for view in views], orders)
        withdrawn = views[:: joins // dropouts][:dropouts]
        run_concurrently(lambda view: withdraw(client, view), withdrawn)
        rejoined = run_concurrently(join, [{}] * dropouts)
        current = [*(view for view in views if view not in withdrawn), *rejoined]
        refilled = imbalance([view["sequence"] for view in current], orders)
        # One ahead if the last block is not full, none if it is.
        expected = int(joins % orders > 0)
        assert (name, joined, refilled) == (name, expected, expected)
        assert sorted(view["slot"]["index"] for view in current) == list(range(joins))
        assert {view["slot"]["index"] for view in rejoined} == {
            one["slot"]["index"] for one in withdrawn
        }
        if "explicit" not in text:
            check_carry_over(client, key, levels)


def check_carry_over(client: Client, key: str, levels: int) -> None:
    """Require that each ordered pair of neighbours is equally frequent in each ledger block."""
    slots = ok(client.get(f"/api/studies/{key}/ledger"))["slots"]
    for block in {slot["block"] for slot in slots}:
        rows = [slot["sequence"] for slot in slots if slot["block"] == block]
        pairs = Counter(pair for row in rows for pair in pairwise(row))
        assert len(pairs) == levels * (levels - 1)
        assert len(set(pairs.values())) == 1


def withdraw(client: Client, view: Json) -> Json:
    """Start a session and withdraw its participant."""
    path = f"/api/sessions/{view['id']}/commands"
    started = ok(client.post(path, json=command(view, "start")))
    left: Json = ok(client.post(path, json={**command(started, "withdraw"), "reason": "unwell"}))
    return left


def command(view: Json, kind: str) -> Json:
    """Return a command decided on this view of the session."""
    return {
        "command_id": f"{kind}-{view['id']}"[:36],
        "expected_version": view["version"],
        "type": kind,
    }
