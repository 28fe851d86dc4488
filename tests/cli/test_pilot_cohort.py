"""Tests of `reembody pilot STUDY`: same visits however they are shared out, resuming, and words."""

import json
import re
from pathlib import Path
from typing import Any

import pytest

from app.cli.errors import INCOMPLETE
from app.cli.pilot.run import CohortOptions, carry_out_cohort
from app.features.results.pilot.simulation import Cohort, CohortOrder, Sharing
from app.features.results.pilot.simulation.cohort_record import open_record
from tests.cli.invoked import Invoked
from tests.protocol.helpers import CONFIGS

_COMMAND = Invoked("pilot")
_PEOPLE = ("--participants", 3, "--seed", 5)


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a hand study of two latencies with short phases and a copy as its avatar."""
    text = (CONFIGS / "templates" / "two-latencies-hand.yaml").read_text(encoding="utf-8")
    text = re.sub(r"duration_s: 60", "duration_s: 3", text)
    text = re.sub(r"avatar: physics\navatar_configuration: .*", "avatar: delayed_copy", text)
    file = tmp_path_factory.mktemp("study") / "study.yaml"
    file.write_text(text, encoding="utf-8")
    return file


@pytest.fixture(scope="module")
def whole(study: Path, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, dict[str, Any]]:
    """Return the record and the report of the cohort, simulated in this process."""
    record = tmp_path_factory.mktemp("whole") / "cohort.jsonl"
    return record, _COMMAND.figures(study, *_PEOPLE, "--out", record)


def _simulated(
    study: Path, out: Path, *, workers: int = 1, shard: tuple[int, int] = (0, 1)
) -> Cohort:
    """Simulate the same cohort, or a part of it, without a report."""
    options = CohortOptions(str(study), CohortOrder(3, 5), Sharing(workers, shard), out)
    return carry_out_cohort(options, lambda _: None)[1]


def _without_machine(report: dict[str, Any]) -> dict[str, Any]:
    return {key: value for key, value in report.items() if key != "real_time_factor"}


def test_the_same_bytes_however_it_is_shared_out(
    study: Path, whole: tuple[Path, dict[str, Any]], tmp_path: Path
) -> None:
    """Two processes write the same record, and three shards merge to the same report."""
    record, report = whole
    two = tmp_path / "two.jsonl"
    _simulated(study, two, workers=2)
    assert two.read_bytes() == record.read_bytes()
    shards = [tmp_path / f"{part}.jsonl" for part in range(3)]
    for part, shard in enumerate(shards):
        assert _simulated(study, shard, shard=(part, 3)).unfinished == 2
    merged = _COMMAND.figures("merge", *shards, "--study", study)
    assert _without_machine(merged) == _without_machine(report)
    assert merged["real_time_factor"] is None
    assert "is no shipped one: give its file with --study" in _COMMAND.refusal("merge", *shards)


def test_a_part_is_no_finished_cohort(study: Path, tmp_path: Path) -> None:
    """One part of two says in all its words that it is unfinished, and which part is missing."""
    part = tmp_path / "part.jsonl"
    printed = _COMMAND.run(study, *_PEOPLE, "--shard", "1/2", "--out", part).stdout
    assert printed.startswith("SIMULATED, UNFINISHED: 2 of 3 people")
    assert "missing: 1 people. To finish, run --shard 2/2, and merge all parts" in printed
    assert "rehearsed with" not in printed
    merged = _COMMAND.run("merge", part, "--study", study)
    assert (merged.exit_code, merged.stdout) == (INCOMPLETE, _without_speed(printed))
    assert "run --shard 2/2" in merged.stderr
    figures = json.loads(_COMMAND.run("merge", part, "--study", study, "--json").stdout)
    assert (figures["unfinished"], figures["paragraphs"]) == (1, {})


def _without_speed(text: str) -> str:
    """Return a report without the line on this machine's speed, as a merge prints it."""
    return "".join(
        line
        for line in text.splitlines(keepends=True)
        if "each second of processor time" not in line
    )


def test_a_killed_run_resumes(
    study: Path, whole: tuple[Path, dict[str, Any]], tmp_path: Path
) -> None:
    """A record that ends in the middle of a line is continued to the same bytes."""
    record, report = whole
    lines = record.read_text(encoding="utf-8").splitlines(keepends=True)
    killed = tmp_path / "killed.jsonl"
    killed.write_text("".join(lines[:3]) + lines[3][:50], encoding="utf-8")
    again = _simulated(study, killed)
    assert killed.read_bytes() == record.read_bytes()
    assert again.sha256 == report["sha256"]


def test_the_report_marks_itself_and_has_what_forms_ask_for(
    whole: tuple[Path, dict[str, Any]],
) -> None:
    """The JSON says that it is simulated, whom it reached, what was done, and gives both texts."""
    report = whole[1]
    assert report["simulated"] is True
    assert report["participants"] == 3
    assert report["failures"] == 0
    assert report["real_time_factor"] > 0.0
    assert {one["stature_m"] for one in report["reach"]} == {1.518, 1.869}
    assert {one["latency_ms"] for one in report["phases"]} == {0.0, 200.0}
    assert all(one["people"] == 3 for one in report["phases"])
    assert "simulated people (seed 5)" in report["paragraphs"]["ethics"]
    assert "nothing is assumed yet" in report["paragraphs"]["preregistration"]


def test_the_text_has_the_words_and_limits_of_the_page(
    study: Path, whole: tuple[Path, dict[str, Any]]
) -> None:
    """Measures have the page's names and units, and the known limitations stand with them."""
    printed = _COMMAND.run("merge", whole[0], "--study", study).stdout
    assert "sides touched  red (s)  early touches  walks back (s)  no task" in printed
    assert "Red time is summed over the sides" in printed
    assert "Known limitations: simulated people do not get used to a latency" in printed
    assert "Do not rely on completions at long latencies." in printed
    assert not re.search("side_contacts|contact_time_s|out_of_order", printed)
    assert "Breaks and putting on the equipment are not included." in printed


def test_the_text_says_who_completed_nothing(
    study: Path, whole: tuple[Path, dict[str, Any]]
) -> None:
    """Beside what the check found stands what it leaves out, and how many complete no task."""
    printed = _COMMAND.run("merge", whole[0], "--study", study).stdout
    assert "It does\n  not say whether people complete tasks." in printed
    assert re.search(r"FOUND: many completed no task: [1-3] of 3 \(hand task, \d+ ms\)", printed)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("--participants", 0), "1 to 10000 are valid"),
        (("--workers", 65), "1 to 64 are valid"),
        (("--shard", "1/3"), "--shard needs --out"),
        (("--avatar", "robot"), "physics_without_fingers and delayed_copy are valid"),
    ],
)
def test_unusable_input_is_refused(study: Path, arguments: tuple[object, ...], said: str) -> None:
    """What cannot be simulated is refused, with what is valid."""
    assert said in _COMMAND.refusal(study, *arguments)


def test_another_cohort_is_not_continued(
    study: Path, whole: tuple[Path, dict[str, Any]], tmp_path: Path
) -> None:
    """A record of another seed is refused and left as it was; so is one of another shard."""
    record, _ = whole
    before = record.read_bytes()
    said = _COMMAND.refusal(study, "--participants", 3, "--seed", 6, "--out", record)
    assert "it differs in seed" in said
    copy = tmp_path / "copy.jsonl"
    copy.write_bytes(before)
    assert "another shard" in _COMMAND.refusal(study, *_PEOPLE, "--shard", "2/2", "--out", copy)
    assert copy.read_bytes() == before
    assert json.loads(before.splitlines()[0])["simulated"] is True


@pytest.mark.parametrize(
    ("line", "written", "instead", "said"),
    [
        (1, '"participants": 3', '"participants": 1', "there is no visit 1 of 1 people"),
        (1, '"participants": 3', '"participants": "x"', "participants: Input should be a valid"),
        (1, ', "avatar": "delayed_copy"', "", "avatar: Field required"),
        (2, '"number": 0', '"number": 77', "there is no visit 77 of 3 people, counted from 0"),
        (2, '"number": 0', '"number": -5', "there is no visit -5"),
        (2, '"number": 0', '"number": "a"', "number: Input should be a valid integer"),
        (2, '"number": 0', '"number": 1', "visit 1 is there already"),
        (2, '"simulated_s": ', '"simulated_s": "abc", "more": ', "simulated_s: Input should be"),
        (2, '"simulated_s": ', '"simulated_s": NaN, "more": ', "NaN is not a finite number"),
    ],
)
def test_a_damaged_record_is_refused_at_its_line(
    whole: tuple[Path, dict[str, Any]],
    tmp_path: Path,
    line: int,
    written: str,
    instead: str,
    said: str,
) -> None:
    """What is no visit of the cohort would go into the report, so the record is refused."""
    lines = whole[0].read_text(encoding="utf-8").splitlines(keepends=True)
    assert written in lines[line - 1]
    lines[line - 1] = lines[line - 1].replace(written, instead, 1)
    damaged = tmp_path / "damaged.jsonl"
    damaged.write_text("".join(lines), encoding="utf-8")
    refusal = _COMMAND.refusal("merge", damaged)
    assert "damaged.jsonl, line" in refusal
    assert said in refusal


def test_records_that_tell_a_visit_differently_are_refused(
    whole: tuple[Path, dict[str, Any]], tmp_path: Path
) -> None:
    """Else the report would depend on the order in which they are given."""
    record = whole[0]
    text = record.read_text(encoding="utf-8")
    other = tmp_path / "other.jsonl"
    other.write_text(
        re.sub(r'"simulated_s": [\d.]+', '"simulated_s": 99.5', text, count=1), "utf-8"
    )
    for records in ((record, other), (other, record)):
        assert "tell visit 0 differently" in _COMMAND.refusal("merge", *records)


def test_one_record_is_written_by_one_process_at_a_time(
    study: Path, whole: tuple[Path, dict[str, Any]], tmp_path: Path
) -> None:
    """A second process is refused while the first writes, and the record stays as it was."""
    copy = tmp_path / "copy.jsonl"
    copy.write_bytes(whole[0].read_bytes())
    header = json.loads(copy.read_text(encoding="utf-8").splitlines()[0])
    with (
        open_record(copy, header, range(3)),
        pytest.raises(ValueError, match="another process is writing"),
    ):
        _simulated(study, copy)
    assert copy.read_bytes() == whole[0].read_bytes()
