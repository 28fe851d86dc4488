"""A headset that lies is noticed, never believed silently; an honest one is never accused."""

from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.faults.figures import note
from tests.faults.lying_streams import LIES, Outcome, play
from tests.faults.short_study import KEY, short_study
from tests.faults.simulated_headset import Site
from tests.support.sqlite import fresh_sqlite

HONEST, LYING = 12, len(LIES)
MANY_HONEST, MANY_LYING = 300, 1000


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Site]:
    """An application in simulated time."""
    folder: Path = tmp_path_factory.mktemp("lying")
    site = Site.open(fresh_sqlite(folder / "reembody.sqlite"), folder, short_study(), KEY)
    yield site
    site.context.database.close()


def lying(site: Site, count: int) -> list[Outcome]:
    """So many streams, every lie in its turn."""
    names = list(LIES)
    return [play(site, seed, names[seed % len(names)]) for seed in range(count)]


def honest(site: Site, count: int) -> list[Outcome]:
    """So many honest streams."""
    return [play(site, 1_000_000 + seed) for seed in range(count)]


def tell(outcomes: list[Outcome], what: str) -> list[str]:
    """The figures, and every stream that did not end as it should."""
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
    """Whatever is told that cannot be is refused, or stored and doubted."""
    assert tell(lying(site, LYING), "lying") == []


def test_no_honest_headset_is_doubted(site: Site) -> None:
    """Jitter, drift, late journals, broken connections, new clients, pauses, a wall clock set."""
    assert tell(honest(site, HONEST), "honest") == []


@pytest.mark.long
@pytest.mark.timeout(3600)
def test_none_of_a_thousand_lies_is_believed(site: Site) -> None:
    """The long form, with three hundred honest streams beside them."""
    told = lying(site, MANY_LYING)
    assert tell(told, "lying") == []
    kinds = Counter(doubt.kind for one in told for doubt in one.doubts)
    note(19, "doubts by kind", "streams", dict(kinds))
    assert tell(honest(site, MANY_HONEST), "honest") == []
