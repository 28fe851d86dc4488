"""Tests of the effects of a new entry in each registry, and of the number of files touched.

Every recipe follows its section of CONTRIBUTING.md in a copy of the tree.
"""

from pathlib import Path

from tests.architecture.recipes import Edit, Json, Recipe, Tree, after, before

PAGE_TEXTS = "frontend/src/shared/session/registries.generated.ts"
CHECKS = "app/features/record/preflight/checks/registry.py"
TESTS = "app/science/statistical_tests/registry.py"
WRITERS = "app/adapters/captures/writers.py"
FORMATS = "app/adapters/captures/formats.py"
RIGHTS = "app/features/care/rights"
COLUMNS = "frontend/src/console/pages/study/participants/ParticipantTable.tsx"

PREFLIGHT_CHECK = Recipe(
    name="pre-flight check",
    heading="Add a pre-flight check",
    added={
        "app/features/record/preflight/notes_check.py": '''"""Whether the session is somebody's."""

from app.features.record.preflight.check import Finding, Found, Situation, StateCheck
from app.texts import Words


def _code(situation: Situation) -> Found:
    return Found("ok" if situation.session.participant_id else "nobody")


CODE = StateCheck(
    key="code",
    title=Words(en="Participant", de="Person"),
    findings=(
        Finding(
            "nobody",
            "fail",
            Words(en="Nobody yet", de="Noch niemand"),
            remedy=Words(en="Join again.", de="Neu beitreten."),
        ),
        Finding("ok", "ok", Words(en="Known", de="Bekannt")),
    ),
    run=_code,
)
'''
    },
    edited={
        CHECKS: [
            before(
                "from app.features.record.preflight.checks.storage",
                "from app.features.record.preflight.notes_check import CODE\n",
            ),
            after("    CONFIGURATION,\n    LANGUAGE,\n", "    CODE,\n"),
        ]
    },
)
STATISTICAL_TEST = Recipe(
    name="statistical test",
    heading="Add a statistical test",
    added={
        "app/science/statistical_tests/quade.py": '''"""Quade's test: ranks, weighted by ranges."""

import numpy as np
from scipy.special import fdtrc
from scipy.stats import rankdata

from app.science.statistical_tests.outcomes import by_level, p_words
from app.science.statistical_tests.sample import Outcome, Sample


def quade_outcome(sample: Sample) -> Outcome:
    """F of ranks within participants, each weighted by the rank of the participant's range."""
    n, k = sample.values.shape
    ranks = rankdata(sample.values, axis=1)
    weights = rankdata(np.ptp(sample.values, axis=1))
    scores = weights[:, np.newaxis] * (ranks - 0.5 * (k + 1))
    between = float(np.square(scores.sum(axis=0)).sum()) / n
    f = (n - 1) * between / (float(np.square(scores).sum()) - between)
    p = float(fdtrc(k - 1, (k - 1) * (n - 1), f))
    return Outcome(
        n=n,
        p=p,
        sentence=f"F({k - 1}, {(k - 1) * (n - 1)}) = {f:.2f}, {p_words(p)}, n = {n}",
        columns=("condition", "mean rank"),
        rows=by_level(sample, ranks.mean(axis=0).tolist()),
        method="Quade's test.",
    )
'''
    },
    edited={
        TESTS: [
            Edit(
                "(FRIEDMAN, PAGE_TREND, RM_ANOVA, AGAINST_REFERENCE)",
                "(FRIEDMAN, PAGE_TREND, RM_ANOVA, AGAINST_REFERENCE, QUADE)",
            ),
            before(
                "TESTS: tuple[StatisticalTest, ...]",
                """QUADE = StatisticalTest(
    key="quade",
    name=Words(en="Quade’s test", de="Quade-Test"),
    phrase="Quade's test",
    question="Do the latencies differ, by weighted ranks?",
    directions=("two_sided",),
    fewest_conditions=3,
    needs_reference=False,
    assumptions="Ranges of participants can be compared.",
    effect_size="none",
    source="Quade 1979, J. Am. Stat. Assoc. 74:680.",
    outcome="quade.quade_outcome",
)
""",
            ),
        ],
        "docs/statistics.md": [
            before("| which ones? |", "| by weighted ranks? | `quade_outcome` | Quade's F |\n")
        ],
        "docs/preregistration.md": [before("`rm_anova` (Greenhouse-Geisser)", "`quade`, ")],
    },
)
EXPORT_FORMAT = Recipe(
    name="export format",
    heading="Add an export format",
    added={
        "app/adapters/captures/tsv_export.py": '''"""The table of a movement with tabs."""

from collections.abc import Iterator

from app.adapters.captures.table_export import to_csv
from app.science.rig import RigMotion


def to_tsv(motion: RigMotion) -> Iterator[str]:
    """Yield the text in pieces."""
    for piece in to_csv(motion):
        yield piece.replace(",", "\\t")
'''
    },
    edited={
        WRITERS: [
            after("import to_csv\n", "from app.adapters.captures.tsv_export import to_tsv\n"),
            after(
                "        write=to_csv,\n    ),\n",
                """    MovementWriter(
        key="tsv",
        media_type="text/tab-separated-values",
        name=Words(en="Table with tabs", de="Tabelle mit Tabs"),
        write=to_tsv,
    ),
""",
            ),
        ]
    },
)
CAPTURE_FORMAT = Recipe(
    name="capture format",
    heading="Add a capture format",
    added={
        "app/adapters/captures/dot_log.py": '''"""A log of one dot: "DOT LOG", then x, y, z in m."""

import numpy as np

from app.adapters.captures.capture import (
    Capture,
    CaptureError,
    Convention,
    Conventions,
    Limits,
    Reading,
)
from app.adapters.captures.text import text_lines
from app.science.rig import MarkerMotion


def read_dot_log(data: bytes, *, name: str, reading: Reading, limits: Limits) -> Capture:
    """Read the log; raises CaptureError with the line."""
    del name, reading, limits
    rows = []
    for line, text in enumerate(text_lines(data), 1):
        if line > 1 and text.strip():
            cells = text.split()
            if len(cells) != 3:
                raise CaptureError("a row has x, y and z.", line=line)
            rows.append([[float(cell) for cell in cells]])
    own = Convention("m", "format")
    return Capture(
        "dot-log", MarkerMotion(("dot",), 60.0, np.array(rows)), Conventions(own, own, own, own)
    )
'''
    },
    edited={
        FORMATS: [
            after(
                '            de="Headset und Hände. Bewegungsprotokolle von Quest-Anwendungen.",\n'
                "        ),\n    ),\n",
                """    CaptureFormat(
        key="dot-log",
        title="Dot log",
        extensions=(".dot",),
        recognises=lambda head: head.first == "DOT LOG",
        reader="dot_log.read_dot_log",
        name=Words(en="Dot log", de="Punkt-Log"),
        source=Words(en="One marker.", de="Ein Marker."),
    ),
""",
            )
        ]
    },
)
PARTICIPANTS_COLUMN = Recipe(
    name="participants column",
    heading="Add a column to the participants page",
    edited={
        f"{RIGHTS}/schemas.py": [
            after("    sessions: list[ParticipantSession]\n", "    visits: int\n")
        ],
        f"{RIGHTS}/participants.py": [
            after("        sessions=sessions,\n", "        visits=len(sessions),\n")
        ],
        COLUMNS: [
            before(
                '  { key: "sessions"',
                '  {\n    key: "visits",\n    title: { en: "Visits", de: "Besuche" },\n'
                "    Cell: ({ participant }) => <>{participant.visits}</>,\n  },\n",
            )
        ],
    },
)

FIGURE = Recipe(
    name="figure",
    heading="Add a figure",
    added={
        "app/features/results/analysis/figures/joined.py": '''"""How many have joined."""

import pandas as pd

from app.features.results.analysis.figures.drawing import Drawing, participants


def joined_drawing(sessions: pd.DataFrame) -> Drawing:
    """From all rows of the table of sessions."""
    n = participants(sessions)
    return Drawing("joined", "Joined", f"{n} have joined.", n, empty="Nothing to draw.")
'''
    },
    edited={
        "app/features/results/analysis/figures/registry.py": [
            before(
                "from app.features.results.analysis.figures.likert",
                "from app.features.results.analysis.figures.joined import joined_drawing\n",
            ),
            after(
                "FIGURES: tuple[Figure, ...] = (\n",
                '    Figure.one("progress", "joined", '
                "lambda rows: joined_drawing(rows.filtered.sessions)),\n",
            ),
        ]
    },
)
ALARM = Recipe(
    name="alarm",
    heading="Add an alarm",
    edited={
        "app/features/record/alarms/kinds.py": [
            after(
                "ALARMS: tuple[AlarmKind, ...] = (\n",
                """    AlarmKind(
        key="asleep",
        severity="info",
        title=Words(en="Headset asleep", de="Headset schläft"),
        remedy=Words(en="Wake it.", de="Aufwecken."),
    ),
""",
            )
        ],
        "app/features/record/alarms/watches/silence.py": [
            after(
                '                unit="s",\n            )\n',
                """        elif self._last_frame_s < now_s:
            yield Condition("asleep", "The headset sleeps")
""",
            )
        ],
    },
)


def _applied(recipe: Recipe, folder: Path, *, edited: int) -> Tree:
    """Return the copy with a recipe applied, which must keep to its limit and its section."""
    tree = recipe.apply(folder, PAGE_TEXTS)
    count = tree.count()
    assert count["edited"] <= edited, count
    assert recipe.unnamed_files() == set()
    return tree


def _enabled(tree: Tree, script: str) -> Json:
    """Return the script's answer, after writing the pages' texts of the registries."""
    return tree.evaluate(f"from app.cli.page_texts import main\nmain()\n{script}")


def _texts(tree: Tree, *lines: str) -> None:
    """Assert that the generated texts of the pages contain each of these lines."""
    table = tree.read(PAGE_TEXTS)
    assert [line for line in lines if f"  {line},\n" not in table] == []


def test_a_preflight_check_takes_one_edited_file(tmp_path: Path) -> None:
    """A new pre-flight check edits one file and appears in interface, session and cockpit."""
    tree = _applied(PREFLIGHT_CHECK, tmp_path, edited=1)
    answer = _enabled(
        tree,
        """
from types import SimpleNamespace
from pydantic import TypeAdapter
from app.features.record.preflight.check import Situation
from app.features.record.preflight.checks.registry import CHECKS
from app.features.record.preflight.schemas import Check, OverrideRequest
from app.features.record.preflight.service import _line
check = CHECKS[-1]
found = check.run(Situation(SimpleNamespace(participant_id=None), None, None))
OverrideRequest(check="code", reason="known")
answer = [_line(check, found).model_dump(), Check.model_json_schema()["properties"]["key"]["enum"]]
""",
    )
    assert (answer[0]["status"], answer[0]["code"]) == ("fail", "code.nobody")
    assert "code" in answer[1]
    _texts(
        tree,
        '"preflight.check.code": "Participant"',
        '"preflight.todo.code.nobody": "Neu beitreten."',
    )


def test_a_statistical_test_takes_at_most_three_edited_files(tmp_path: Path) -> None:
    """A new statistical test edits at most three files, and studies and the command can use it."""
    tree = _applied(STATISTICAL_TEST, tmp_path, edited=3)
    tree.write(
        "table.csv",
        "who,dose,score\n"
        + "".join(
            f"p{person},{dose},{score}\n"
            for person, row in enumerate(
                ((5, 4, 7), (1, 3, 1), (16, 12, 22), (0, 2, 0), (10, 9, 7))
            )
            for dose, score in zip("abc", row, strict=True)
        ),
    )
    answer = _enabled(
        tree,
        """
import pandas as pd
from app.cli.analyse.output_json import as_json
from app.cli.analyse.run import AnalyseOrder, carry_out
from app.features.results.analysis.questions.limb_tests import limb_results
from app.features.results.analysis.questions.measures import Measure
from app.features.results.preregistration.declaration import primary_words
from app.protocol import PrimaryTest
table = pd.read_csv("table.csv")
own = pd.DataFrame({"participant_code": table.who, "limb": "hand", "value": table.score,
                    "latency_ms": table.dose.map({"a": 0.0, "b": 125.0, "c": 350.0})})
measure = Measure("m", "Score", "points", "", own, own, continuous=False)
order = AnalyseOrder(pathlib.Path("table.csv"), "who", ["dose"], "score", None, False)
answer = {
    "declared": primary_words(PrimaryTest(measure="completions", limb="hand", test="quade")),
    "page": [one.view().apa for one in limb_results(measure, "hand", 0.05) if "quade" in one.key],
    "command": as_json(carry_out(order))["families"][0]["quade"],
}
""",
    )
    assert answer["declared"].startswith("Quade's test of completed tasks in the hand task")
    assert answer["page"] == [f"Score, hand task, Quade's test: {answer['command']['words']}"]
    assert answer["command"]["n"] == 5
    _texts(tree, '"value.quade": "Quade’s test"', '"value.quade": "Quade-Test"')


def test_an_export_format_takes_at_most_two_edited_files(tmp_path: Path) -> None:
    """A new export format edits at most two files, and interface, command and page offer it."""
    tree = _applied(EXPORT_FORMAT, tmp_path, edited=2)
    answer = _enabled(
        tree,
        """
import numpy as np
from typing import get_args
from app.adapters.captures import writer_of
from app.cli.retarget.run import write_motion
from app.features.movement.captures.schemas import ExportFormat
from app.science.retargeting import reference_avatar
from app.science.rig import RigMotion
rig = reference_avatar(1.75)
turns = np.zeros((2, len(rig.names), 4))
turns[..., 0] = 1.0
seen = np.ones((2, len(rig.names)), dtype=bool)
motion = RigMotion(rig, 60.0, np.zeros((2, 3)), turns, seen)
write_motion(pathlib.Path("still.tsv"), motion)
answer = [list(get_args(ExportFormat)), pathlib.Path("still.tsv").read_text().splitlines()]
""",
    )
    assert answer[0] == ["bvh", "csv", "tsv"]
    assert answer[1][0].startswith("frame\ttime_s\t")
    assert len(answer[1]) == 3
    _texts(tree, '"movement.format.tsv": "Tabelle mit Tabs"', '"tsv"')


def test_a_capture_format_takes_at_most_two_edited_files(tmp_path: Path) -> None:
    """A new capture format edits at most two files, and its files are recognised and read.

    Messages about rejected files name the format, and the page lists it.
    """
    tree = _applied(CAPTURE_FORMAT, tmp_path, edited=2)
    answer = _enabled(
        tree,
        """
from app.adapters.captures import CaptureError, read_capture
read = read_capture(b"DOT LOG\\n0 1 2\\n0 1 3\\n", name="a.txt")
try:
    read_capture(b"nothing", name="b.dat")
except CaptureError as error:
    refused = str(error)
answer = [read.format, read.motion.frame_count, refused]
""",
    )
    assert answer[:2] == ["dot-log", 2]
    assert "Dot log" in answer[2]
    _texts(tree, '"format.dot-log": "Punkt-Log"', '"dot-log"', '".dot"')


def test_a_column_of_the_participants_page_takes_at_most_three_edited_files(
    tmp_path: Path,
) -> None:
    """A new column of the participants page edits at most three files."""
    tree = _applied(PARTICIPANTS_COLUMN, tmp_path, edited=3)
    answer = _enabled(
        tree,
        """
from app.features.care.rights.participants import _participant
from app.features.care.rights.schemas import ParticipantView
from types import SimpleNamespace
import datetime
row = SimpleNamespace(id="1", code="P01", kind="people", created_at=datetime.datetime.now())
answer = _participant(row, [], [], None).visits
""",
    )
    assert answer == 0
    assert "{participant.visits}" in tree.read(COLUMNS)


def test_a_figure_takes_one_edited_file(tmp_path: Path) -> None:
    """A new figure edits one file, and the dashboard draws it with its group."""
    tree = _applied(FIGURE, tmp_path, edited=1)
    answer = tree.evaluate("""
import pandas as pd
from types import SimpleNamespace
from app.features.results.analysis.figures import FIGURES, Rows
sessions = pd.DataFrame({"participant_code": ["a", "b"]})
(drawing,) = FIGURES[0].draw(Rows(SimpleNamespace(sessions=sessions), invalid=False))
answer = [drawing.key, drawing.group, drawing.n]
""")
    assert answer == ["joined", "progress", 2]


def test_an_alarm_takes_two_edited_files(tmp_path: Path) -> None:
    """A new alarm edits two files, is raised with its severity, and has texts in the cockpit."""
    tree = _applied(ALARM, tmp_path, edited=2)
    answer = _enabled(
        tree,
        """
from app.features.record.alarms import WatchLimits
from app.features.record.alarms.watches.silence import SilenceWatch
(found,) = SilenceWatch(WatchLimits(), 0.0).check(1.0)
answer = [found.code, found.severity]
""",
    )
    assert answer == ["asleep", "info"]
    _texts(tree, '"alarm.asleep": "Headset asleep"', '"alarm.asleep.do": "Aufwecken."', '"asleep"')
