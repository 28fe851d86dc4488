"""Tests that the recipes of CONTRIBUTING.md work and touch no more files than allowed."""

import dataclasses
from pathlib import Path

import pytest

from app.cli.page_texts import TARGET
from tests.architecture.recipes import Edit, Recipe, RecipeError, Tree, after, before

QUESTIONNAIRE = Recipe(
    name="questionnaire",
    heading="Add a questionnaire",
    added={
        "study_configs/instruments/comfort.yaml": """\
key: comfort
version: 1
title: {en: Comfort, de: Behaglichkeit}
languages: [en, de]
provenance: {source: Made up for a test., licence: Apache-2.0, verified: Not validated.}
scale: {minimum: 1, maximum: 7, labels: []}
items:
  - {key: warm, type: likert, text: {en: I felt warm., de: Mir war warm.}}
  - key: restless
    type: likert
    reverse_keyed: true
    text: {en: I felt restless., de: Ich war unruhig.}
scores:
  - key: comfort_score
    label: {en: Comfort, de: Behaglichkeit}
    formula: mean(warm, 8 - restless)
    minimum: 1
    maximum: 7
"""
    },
)
STUDY_WITH_QUESTIONNAIRE = """
from app.protocol import compile_plan, load_instrument, load_study, sequences, visit_time
from app.resources import study_configs_dir

configs = study_configs_dir()
files = (configs / "instruments").glob("*.yaml")
known = {file.stem: load_instrument(file.read_text("utf-8")).instrument for file in files}
text = (configs / "templates" / "two-latencies-hand.yaml").read_text("utf-8")
form = "    - {step: form, instrument: comfort}\\n"
study = load_study(text.replace("  after:\\n", "  after:\\n" + form, 1), instruments=known).protocol
last = compile_plan(study, sequences(study)[0])[-2]
answer = [last.key, last.spec.screen, visit_time(study, known).total > 0]
"""


def test_a_questionnaire_is_one_file(tmp_path: Path) -> None:
    """A questionnaire added as one file can be used by studies and scored by the command line."""
    tree = QUESTIONNAIRE.apply(tmp_path)
    tree.write("answers.csv", "person,warm,restless\n1,7,1\n2,4,6\n")
    scored = tree.run_module("app.cli", "score", "answers.csv", "--instrument", "comfort")
    assert scored.splitlines()[1:] == ["1,7.0", "2,3.0"]
    (tree.root / "answers.csv").unlink()
    assert tree.evaluate(STUDY_WITH_QUESTIONNAIRE) == ["form.comfort", "form", True]
    assert tree.count() == {"recipe": "questionnaire", "edited": 0, "added": 1}
    assert QUESTIONNAIRE.unnamed_files() == set()


PHASE = Recipe(
    name="task phase",
    heading="Add a task phase",
    edited={
        "app/protocol/step_kinds.py": [
            after('    "free_roam",\n', '    "baseline",\n'),
            before(
                '    StepKindSpec(\n        key="practice",\n',
                """\
    StepKindSpec(
        key="baseline",
        name=Words("Baseline", "Grundmessung"),
        icon="chart",
        command="begin_phase",
        phase_key="baseline_{limb}",
        needs_body=True,
        phases={
            Limb.HAND: PhaseWords(
                title=Words("Baseline with the hand", "Grundmessung mit der Hand"),
                in_a_sentence=Words("baseline with the hand", "Grundmessung mit der Hand"),
                begin=Words("Begin the baseline", "Grundmessung beginnen"),
                guidance=Words("Nothing is delayed yet.", "Noch ist nichts verzögert."),
            ),
        },
    ),
""",
            ),
        ],
        "app/protocol/procedure.py": [
            before(
                "class DebriefStep(Strict):\n",
                """\
class BaselineStep(Strict):
    \"""The task of the hand without added latency, before the blocks.\"""

    step: Literal["baseline"]
    limb: Literal[Limb.HAND]
    preparation_s: Pause
    duration_s: Duration
    freeze_s: Pause
    latency_ms: LatencyMs
    text: Key | None = None
    title: Text | None = None


""",
            ),
            after("    | PracticeStep", "\n    | BaselineStep"),
        ],
        "docs/protocol.md": [
            Edit(
                "free_roam, practice, task, road_crossing, questionnaire",
                "free_roam, baseline, practice, task, road_crossing, questionnaire",
            ),
            Edit(
                "`kind` (free_roam, practice, task, road",
                "`kind` (free_roam, baseline, practice, task, road",
            ),
        ],
        "study_configs/README.md": [after("`free_roam`, ", "`baseline`, ")],
    },
)
SESSION_WITH_PHASE = """
from app.features.record.sessions.engine import (
    allowed_commands, commands, decide, events, evolve, initial_state
)
from app.features.results.analysis.codebook import codebook_frame
from app.protocol import (
    BOX_KINDS, ConfigError, compile_plan, load_instrument, load_study, sequences
)
from app.resources import study_configs_dir

configs = study_configs_dir()
files = (configs / "instruments").glob("*.yaml")
known = {file.stem: load_instrument(file.read_text("utf-8")).instrument for file in files}
text = (configs / "templates" / "two-latencies-hand.yaml").read_text("utf-8")
phase = (
    "    - {step: baseline, limb: hand, preparation_s: 3, duration_s: 60, freeze_s: 0,"
    " latency_ms: 0}\\n"
)
body = "    - {step: materialise, text: t_pose}\\n"
rules = "    - {phase: baseline_hand, min_active_share: 0.5}\\n"
text = text.replace("    - {phase: hand,", rules + "    - {phase: hand,", 1)
study = load_study(text.replace(body, body + phase, 1), instruments=known).protocol
plan = compile_plan(study, sequences(study)[0])
at, step = next((at, one) for at, one in enumerate(plan) if one.kind == "baseline")

state = evolve(initial_state(len(plan)), events.SessionStarted())
for index in range(at):
    state = evolve(state, events.StepSkipped(step=index, content_id="", content_hash=""))
begun = decide(plan, state, commands.BeginPhase(headset_connected=True))
try:
    load_study(text.replace(body, phase + body, 1), instruments=known)
    refused = None
except ConfigError as error:
    refused = error.problems[0].message
levels = codebook_frame().query("table == 'phases' and column == 'phase_kind'")["levels"]
answer = {
    "step": [step.key, step.title["de"], step.limb, step.duration_s, step.phase_key],
    "first command": allowed_commands(plan, state)[0],
    "event": begun[0].type,
    "has boxes": "baseline" in BOX_KINDS,
    "without a body": refused,
    "codebook": list(levels),
}
"""


def test_a_task_phase_edits_at_most_five_files(tmp_path: Path) -> None:
    """A new task phase edits at most five files and works in studies, sessions and pages."""
    tree = PHASE.apply(tmp_path, TARGET)
    assert tree.evaluate(SESSION_WITH_PHASE) == {
        "step": ["baseline.hand", "Grundmessung mit der Hand", "hand", 60.0, "baseline_hand"],
        "first command": "begin_phase",
        "event": "phase_prepared",
        "has boxes": True,
        "without a body": "The step “baseline” comes before the participant has a body.",
        "codebook": ["free_roam, baseline, practice, task, road_crossing"],
    }
    tree.run_module("app.cli.page_texts")
    pages = tree.read(TARGET)
    assert '"baseline": {"family": "timed", "icon": "chart", "limbs": ["hand"],' in pages
    assert '"do.begin.baseline.hand": "Grundmessung beginnen"' in pages
    assert tree.changed()[0] == {*PHASE.edited, TARGET}
    assert tree.count() == {"recipe": "task phase", "edited": 4, "added": 0}
    assert PHASE.unnamed_files() == set()


EXAMPLE = Recipe(
    name="example",
    heading="Recipes",
    added={"app/words.py": "WORD = 'new'\n", "tests/test_words.py": ""},
    edited={
        "app/clock.py": [after("import time\n", "\nfrom app.words import WORD as WORD\n")],
        "docs/data-dictionary.md": [Edit("# Data dictionary", "# Words")],
    },
)
"""Adds a module to the server and edits one; the test and the generated file do not count."""


@pytest.fixture(scope="module")
def example(tmp_path_factory: pytest.TempPathFactory) -> Tree:
    """Provide the tree with the example applied."""
    return EXAMPLE.apply(tmp_path_factory.mktemp("example"))


def test_a_recipe_is_applied_to_a_copy_and_counted(example: Tree) -> None:
    """The copy of a recipe runs with its edits, and its edited and added files are counted."""
    assert example.evaluate("import app.clock; answer = app.clock.WORD") == "new"
    assert example.changed() == (
        {"app/clock.py", "docs/data-dictionary.md"},
        {"app/words.py", "tests/test_words.py"},
    )
    assert example.count() == {"recipe": "example", "edited": 1, "added": 1}
    assert EXAMPLE.unnamed_files() == {"app/clock.py", "app/words.py"}


def test_a_recipe_that_no_longer_fits_says_where(tmp_path: Path) -> None:
    """A recipe fails if a text to edit is not unique or a file to add exists."""
    strays = {"app/clock.py": [Edit("import timing", "import time")]}
    with pytest.raises(RecipeError, match=r"'import timing' in app/clock.py, which has it 0 times"):
        dataclasses.replace(EXAMPLE, edited=strays).apply(tmp_path)
    with pytest.raises(RecipeError, match=r"adds app/clock.py, which is there already"):
        dataclasses.replace(EXAMPLE, added={"app/clock.py": ""}).apply(tmp_path)


def test_a_script_that_fails_shows_its_output(example: Tree) -> None:
    """The error of a failed script contains the output of the copy's process."""
    with pytest.raises(RecipeError, match=r"No module named 'app.absent'"):
        example.evaluate("import app.absent; answer = 1")
