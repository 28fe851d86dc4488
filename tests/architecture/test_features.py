"""Features know little of each other: what one may import of another is listed here."""

import ast
from collections.abc import Iterator
from pathlib import Path

FEATURES = Path(__file__).resolve().parents[2] / "app" / "features"
ALWAYS = {"service", "schemas"}
"""What a feature does, and what travels in its name."""
ALSO = {
    "audit": {
        "copies",  # whoever hands out a copy of data puts it on record
    },
    "sessions": {
        "engine",  # commands and state are the words in which features speak of a session
        "contents",  # words beside the event log
        "consent",  # the tablet hands in what the participant agreed to
        "consent_schemas",
        "journal",  # the log's canonical JSON and its hash chain
        "capture",  # whose sessions take no more data
    },
    "telemetry": {
        "frames",  # reading movement back
        "encoding",  # what a frame is
        "positions",  # how far streams are stored
        "writer",  # the headset's socket hands its messages over here
        "outcome",  # and hears what became of them
        "live",  # the figures that do not wait for the commit
        "hinges",  # what a physics avatar is asked for, moment by moment
    },
    "alarms": {
        "alarm",  # the writer stores changes of alarms
        "limits",  # the headset's socket is watched
        "watch",
    },
    "captures": {
        "contents",  # humanoid models are kept beside captures, once by their hash
        "uploads",  # and taken in the same way
        "downloads",
        "binary",
        "workbench",  # and measured in the same process
    },
    "erasure": {
        "overwriting",  # imported answers are erased, too
        "traces",
    },
    "exports": {
        "desk",  # files of a study go when one of its participants is erased
    },
    "analysis": {
        "tables",  # an export is the tables
        "codebook",  # and their columns
        "clocks",  # where a run of the headset lies on the wall clock
    },
}


def imports() -> Iterator[tuple[str, str, str]]:
    """(importing file, other feature, its module) for every import across features."""
    for file in sorted(FEATURES.glob("*/*/**/*.py")):
        own = file.relative_to(FEATURES).parts[1]
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            if not isinstance(node, ast.ImportFrom) or node.module is None:
                continue
            parts = node.module.split(".")
            if parts[:2] == ["app", "features"] and len(parts) > 4 and parts[3] != own:
                yield str(file.relative_to(FEATURES)), parts[3], parts[4]


def test_a_feature_uses_only_what_another_offers() -> None:
    """Services and schemas are for everybody, other modules only where they are listed."""
    strangers = [
        f"{file} imports {feature}.{module}"
        for file, feature, module in imports()
        if module not in ALWAYS | ALSO.get(feature, set())
    ]
    assert strangers == []


def test_nothing_is_listed_that_nobody_uses() -> None:
    """The list shrinks when an import goes away."""
    used = {(feature, module) for _, feature, module in imports()}
    listed = {(feature, module) for feature, modules in ALSO.items() for module in modules}
    assert listed - used == set()
