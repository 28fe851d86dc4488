"""Tests of whole visits of simulated people with each kind of avatar."""

import re
from typing import get_args

import pytest

from app.protocol import StudyProtocol
from app.simulated_people.visits import AvatarKind, Visit, simulate_visit
from tests.protocol.helpers import CONFIGS, loaded

KINDS: tuple[AvatarKind, ...] = get_args(AvatarKind)


@pytest.fixture(scope="module")
def hand_study() -> StudyProtocol:
    """Return a hand study of two latencies with phases of 4 s."""
    text = (CONFIGS / "templates" / "two-latencies-hand.yaml").read_text(encoding="utf-8")
    return loaded(re.sub(r"duration_s: 60", "duration_s: 4", text)).protocol


def _visits(study: StudyProtocol, kind: AvatarKind) -> tuple[Visit, ...]:
    return tuple(simulate_visit(study, number, 5, kind) for number in range(2))


@pytest.mark.parametrize("kind", KINDS)
def test_a_visit_follows_from_seed_and_number_alone(
    hand_study: StudyProtocol, kind: AvatarKind
) -> None:
    """The same person comes again with the same visit, alone or after others."""
    first, second = _visits(hand_study, kind)
    assert simulate_visit(hand_study, 1, 5, kind) == second
    assert first.build != second.build
    assert first.failure is None


def test_hands_without_fingers_are_stopped_by_boxes_too(hand_study: StudyProtocol) -> None:
    """The same people come with both hands: they touch sides with either, but not the same."""
    with_fingers = _visits(hand_study, "physics")
    without = _visits(hand_study, "physics_without_fingers")
    assert [one.build for one in without] == [one.build for one in with_fingers]
    for visits in (with_fingers, without):
        assert sum(phase.side_contacts for one in visits for phase in one.phases) > 0
    assert [one.phases for one in without] != [one.phases for one in with_fingers]
