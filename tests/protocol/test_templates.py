"""Tests that each study template is a complete study that can be run unchanged."""

from pathlib import Path

import pytest

from app.protocol import compile_plan, ledger_block, sequences
from app.science.instruments import Instrument
from tests.protocol.helpers import CONFIGS, instruments, loaded

FILES = sorted((CONFIGS / "templates").glob("*.yaml"))
NAMES = [file.stem for file in FILES]


@pytest.mark.parametrize("file", FILES, ids=NAMES)
def test_a_template_is_a_complete_study(file: Path) -> None:
    """A template loads, its orders compile, and its instruments have both languages."""
    protocol = loaded(file.read_text(encoding="utf-8")).protocol
    for order in sequences(protocol):
        assert compile_plan(protocol, order)[-1].kind == "debrief"
    library: dict[str, Instrument] = instruments()
    for key in protocol.instrument_keys:
        assert set(protocol.languages) <= set(library[key].languages)


def test_the_templates_are_four_different_designs() -> None:
    """Conditions, orders and slots of the four templates are as computed by hand."""
    designs = {}
    for file in FILES:
        protocol = loaded(file.read_text(encoding="utf-8")).protocol
        slots = len(ledger_block(protocol, 0)) * protocol.orders.replicates
        designs[file.stem] = (len(protocol.conditions), protocol.orders.design, slots)
    assert designs == {
        "four-latencies-williams": (4, "williams", 16),
        "pilot-listed-orders": (3, "explicit", 4),
        "road-crossing": (2, "all_permutations", 12),
        "two-latencies-hand": (2, "all_permutations", 12),
    }


def test_every_text_of_a_template_is_used() -> None:
    """A template has no unused texts."""
    for file in FILES:
        protocol = loaded(file.read_text(encoding="utf-8")).protocol
        plan = compile_plan(protocol, sequences(protocol)[0])
        used = {step.text for step in plan} | {"waiting", "freeze", "walk_back"}
        assert set(protocol.texts) <= used, file.stem
