"""Tests that the claims of docs/claims.md still hold: figures, limits, pages and commands."""

import importlib
import re

import pytest

from tests.benchmarks.__main__ import NAMES
from tests.docs.claims import (
    MEASURED,
    NUMBER,
    OPEN_COLUMNS,
    PAGE,
    Claim,
    as_value,
    claims,
    rows_of,
)
from tests.docs.markdown import DOCS, REPOSITORY

CLAIMS = {claim.key: claim for claim in claims()}
_PROSE = (".md", ".yaml")


def test_every_claim_is_complete_and_named_once() -> None:
    """Each claim has an id of its own, a command, conditions, a figure and a limit."""
    rows = claims()
    assert len(rows) > 30
    assert len(CLAIMS) == len(rows)
    for claim in rows:
        assert all((claim.text, claim.conditions, claim.figure)), claim.key
        assert "`./run " in claim.shown_by, claim.key
        assert re.fullmatch(r"none|(exactly|at most|at least) [\d.,]+", claim.limit), claim.key


def test_the_short_claims_are_those_with_a_measurement() -> None:
    """A row is marked as measured again if and only if it is."""
    assert {claim.key for claim in CLAIMS.values() if claim.short} == set(MEASURED)


@pytest.mark.parametrize("key", MEASURED)
def test_a_short_claim_still_holds(key: str) -> None:
    """What is measured now is what the page says, and keeps the limit."""
    claim, measured = CLAIMS[key], MEASURED[key]()
    assert claim.still_holds(measured), f"{key} says {claim.figure}, measured {measured:g}"
    assert claim.keeps_its_limit(measured)


def test_every_figure_keeps_its_limit() -> None:
    """No figure of the page is beyond the limit beside it."""
    for claim in CLAIMS.values():
        if claim.limit != "none":
            assert claim.value is not None, claim.key
            assert claim.keeps_its_limit(claim.value), claim.key


@pytest.mark.parametrize("claim", CLAIMS.values(), ids=CLAIMS)
def test_every_figure_stands_on_the_page_that_makes_the_claim(claim: Claim) -> None:
    """Each number of a figure is found on the linked page, so that neither changes alone."""
    assert claim.page.is_file(), claim.page
    if claim.page.suffix in _PROSE:
        text = claim.page.read_text(encoding="utf-8")
        there = {as_value(one) for one in NUMBER.findall(text)}
        missing = [one for one in NUMBER.findall(claim.figure) if as_value(one) not in there]
        assert missing == [], f"{claim.page.name} does not say {missing}"


@pytest.mark.parametrize("claim", CLAIMS.values(), ids=CLAIMS)
def test_every_claim_names_what_shows_it(claim: Claim) -> None:
    """Benchmarks and their parts, and files of tests, exist under the names that claims give."""
    for command in re.findall(r"`\./run ([^`]+)`", claim.shown_by):
        words = command.split()
        if words[0] == "bench":
            assert words[1] in NAMES
            if "--only" in words:
                part = words[words.index("--only") + 1]
                assert part in importlib.import_module(f"tests.benchmarks.{words[1]}").PARTS
        elif words[0] == "test":
            paths = [word for word in words[1:] if not word.startswith("-")]
            assert paths
            assert [path for path in paths if not (REPOSITORY / path).exists()] == []


def test_a_changed_figure_is_found() -> None:
    """A figure that is no longer what is measured, and one beyond its limit, are both found."""
    claim = CLAIMS["body-triangles"]
    assert claim.still_holds(11_376.0)
    assert not claim.still_holds(11_377.0)
    error = CLAIMS["latency-error"]
    assert error.still_holds(0.01)
    assert not error.still_holds(0.04)
    assert not error.keeps_its_limit(0.2)
    exact = CLAIMS["stats-friedman"]
    assert not exact.still_holds(0.388)


def test_what_only_a_worn_headset_can_show_is_open() -> None:
    """Each row of the headsets' page about worn headsets is among the open claims, not shown."""
    text = PAGE.read_text(encoding="utf-8")
    still_open = list(rows_of(OPEN_COLUMNS, text))
    assert {row[-1] for row in still_open} == {"not shown"}
    headsets = (DOCS / "headsets.md").read_text(encoding="utf-8")
    listed = list(rows_of(("open", "what closes it"), headsets))
    assert len(listed) == len(still_open) > 0
