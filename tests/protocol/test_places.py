"""A study describes the boxes of the limbs that it uses."""

import yaml

from app.science.tasks import Limb
from tests.protocol.helpers import CONFIGS, SHIPPED, loaded, problems

HAND_ONLY = (CONFIGS / "templates" / "two-latencies-hand.yaml").read_text(encoding="utf-8")


def test_a_study_of_the_hand_needs_no_boxes_for_the_foot() -> None:
    """The smallest template has none, and nothing of them is in its content."""
    study = loaded(HAND_ONLY)
    assert list(study.protocol.tasks.layouts()) == [Limb.HAND]
    assert "foot" not in yaml.safe_load(HAND_ONLY)["tasks"]
    assert '"foot"' not in study.canonical_json


def test_boxes_that_a_phase_needs_are_asked_for() -> None:
    """Their place in the file, and what to do."""
    tree = yaml.safe_load(SHIPPED)
    del tree["tasks"]["foot"]
    [problem] = problems(yaml.safe_dump(tree, allow_unicode=True))
    assert problem.path == "tasks.foot"
    assert problem.message == "The procedure has a phase of the foot, but its boxes are missing."
