"""Tests of the progress that long commands report, with and without a terminal."""

import time
from pathlib import Path

import pytest

from app.cli import progress
from app.cli.errors import ERASE_LINE
from app.cli.progress import Activity
from tests.cli.invoked import Invoked
from tests.features.lab import STUDY

GENEROUS_S = 60.0


@pytest.fixture(autouse=True)
def immediately(monkeypatch: pytest.MonkeyPatch) -> None:
    """Report progress without delay."""
    monkeypatch.setattr(progress, "FIRST_UPDATE_S", 0.0)
    monkeypatch.setattr(progress, "LOG_EVERY_S", 0.01)
    monkeypatch.setattr(progress, "DRAWN_EVERY_S", 0.01)


def said_within(capsys: pytest.CaptureFixture[str], words: str) -> str:
    """Collect standard error until it contains these words, and return it."""
    output, give_up_s = "", time.monotonic() + GENEROUS_S
    while words not in output:
        assert time.monotonic() < give_up_s, output
        output += capsys.readouterr().err
        time.sleep(0.01)
    return output


def test_progress_is_reported_once_per_step(
    capsys: pytest.CaptureFixture[str],
) -> None:
    """Each step is reported once on a line of its own, with the rows of its table added up."""
    with Activity("exporting: opening the database") as activity:
        output = said_within(capsys, "opening the database")
        count = activity.rows("restoring")
        count("events", 2)
        count("events", 3)
        output += said_within(capsys, "events, 5 rows")
    assert output.splitlines()[0] == "reembody: exporting: opening the database"
    assert output.splitlines()[-1] == "reembody: restoring: events, 5 rows"
    assert output.count("opening") == 1


def test_on_a_terminal_the_line_is_overwritten_and_erased(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """On a terminal the progress line is overwritten, and erased before any other output."""
    monkeypatch.setattr("sys.stderr.isatty", lambda: True)
    with Activity("first") as activity:
        message = said_within(capsys, "first")
        with activity.silent():
            activity.now("second")
            time.sleep(0.05)
            query = capsys.readouterr().err
        said_within(capsys, "second")
    assert message == f"{ERASE_LINE}first"
    assert query == ERASE_LINE
    assert capsys.readouterr().err == ERASE_LINE


def test_a_short_command_reports_no_progress(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """A command that ends quickly reports no progress."""
    monkeypatch.setattr(progress, "FIRST_UPDATE_S", GENEROUS_S)
    with Activity("nothing of it"):
        pass
    assert capsys.readouterr().err == ""


@pytest.mark.parametrize(
    ("command", "arguments", "words"),
    [
        ("export", ("--study", STUDY, "--to", "out"), f"exporting {STUDY}: opening the database"),
        ("verify", (), "verifying: opening the database"),
        ("backup", ("out.reembody",), "backing up to out.reembody: opening the database"),
        ("restore", ("out.reembody",), "restoring out.reembody: opening it"),
    ],
)
def test_every_long_command_reports_what_it_does(
    command: str,
    arguments: tuple[str, ...],
    words: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Every command that processes all data reports what it does before it opens anything."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("REEMBODY_DATA_DIR", str(tmp_path / "data"))
    assert f"reembody: {words}\n" in Invoked(command).run(*arguments).stderr
