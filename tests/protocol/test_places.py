"""Tests that a study describes the boxes of the limbs that it uses."""

import yaml

from app.science.tasks import Limb
from tests.protocol.helpers import CONFIGS, SHIPPED, loaded, problems

HAND_ONLY = (CONFIGS / "templates" / "two-latencies-hand.yaml").read_text(encoding="utf-8")


def test_a_study_of_the_hand_needs_no_boxes_for_the_foot() -> None:
    """A study of the hand has no boxes for the foot, neither in its file nor in its content."""
    study = loaded(HAND_ONLY)
    assert list(study.protocol.tasks.layouts()) == [Limb.HAND]
    assert "foot" not in yaml.safe_load(HAND_ONLY)["tasks"]
    assert '"foot"' not in study.canonical_json


def test_missing_boxes_of_a_phase_are_reported() -> None:
    """Missing boxes of a limb that the procedure uses are reported with place and remedy."""
    tree = yaml.safe_load(SHIPPED)
    del tree["tasks"]["foot"]
    [problem] = problems(yaml.safe_dump(tree, allow_unicode=True))
    assert problem.path == "tasks.foot"
    assert problem.message == "The procedure has a phase of the foot, but its boxes are missing."
