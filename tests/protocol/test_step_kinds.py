"""Tests of the table of step kinds, and the places that must agree with it."""

import re
from pathlib import Path
from typing import get_args

from app.protocol import STEP_KINDS, TIMED_KINDS, StepKind
from app.protocol.procedure import Procedure

REPOSITORY = Path(__file__).parents[2]
NAMED_IN = {
    "app/protocol/procedure.py",
    "app/protocol/step_kinds.py",
    "frontend/src/shared/session/registries.generated.ts",
    "frontend/src/shared/api/schema.d.ts",
}
"""Files that may contain a phase kind as a literal: the schema of study files, the table of kinds,
and generated files."""


def test_every_kind_has_its_row() -> None:
    """The table has a row for every kind of step, in the type's order."""
    assert tuple(STEP_KINDS) == get_args(StepKind)


def test_every_kind_says_what_the_experimenter_does() -> None:
    """Every kind has guidance for the experimenter, or its phases have."""
    for kind, spec in STEP_KINDS.items():
        assert spec.phases or spec.guidance is not None, kind


def test_a_kind_is_a_phase_exactly_if_it_is_timed() -> None:
    """Exactly the timed kinds have phases and a phase key, and only they can count."""
    for kind, spec in STEP_KINDS.items():
        is_timed = spec.family == "timed"
        assert bool(spec.phases) == (spec.phase_key is not None) == is_timed, kind
        assert is_timed or not spec.counts, kind


def test_every_step_of_a_study_file_is_of_a_kind() -> None:
    """Every value of `step:` in a study file is a kind of the table."""
    definitions = Procedure.model_json_schema()["$defs"]
    words = {
        one["properties"]["step"]["const"]
        for one in definitions.values()
        if "step" in one.get("properties", {})
    }
    assert words < set(STEP_KINDS)
    # In a block, without `step:`.
    assert set(STEP_KINDS) - words == {"task", "road_crossing", "questionnaire"}


def test_the_documents_name_every_kind() -> None:
    """The documentation of protocol and study files lists every kind."""
    protocol = (REPOSITORY / "docs/protocol.md").read_text(encoding="utf-8")
    assert f"the current step: {', '.join(STEP_KINDS)} |" in protocol
    assert f"`kind` ({', '.join(TIMED_KINDS)})" in protocol
    guide = (REPOSITORY / "study_configs/README.md").read_text(encoding="utf-8")
    for kind in set(STEP_KINDS) - {"task", "questionnaire"}:
        assert f"`{kind}`" in guide, kind


def test_phases_are_called_by_their_kind_in_one_place() -> None:
    """Only the listed files contain a phase kind as a literal."""
    words = "|".join(set(TIMED_KINDS) - {"task"})  # `task` has other meanings, too.
    quoted = re.compile(rf"""["'`]([\w.]+\.)?({words})([._](hand|foot))?["'`]""")
    sources = [*REPOSITORY.glob("app/**/*.py"), *REPOSITORY.glob("frontend/src/**/*.ts*")]
    naming = {
        file.relative_to(REPOSITORY).as_posix()
        for file in sources
        if ".test." not in file.name
        and "testing" not in file.as_posix()
        and quoted.search(file.read_text(encoding="utf-8"))
    }
    assert naming == NAMED_IN
