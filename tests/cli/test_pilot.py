"""Tests of `reembody pilot power` and `pilot merge`: same bytes, resuming, refusals."""

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from app.cli.commands import app
from app.cli.errors import INCOMPLETE
from app.resources import study_configs_dir
from tests.cli.invoked import Invoked

_STUDY = "reembodiment-latency"
_SMALL = ("--participants", "8,12", "--sets", "60", "--seed", "5", "--json")
_COMMAND = Invoked("pilot")


def _power(*more: object) -> str:
    arguments = ["pilot", "power", _STUDY, *_SMALL, *map(str, more)]
    result = CliRunner().invoke(app, arguments)
    assert result.exit_code == 0, result.output
    return result.stdout


def test_the_same_bytes_however_it_is_computed(tmp_path: Path) -> None:
    """One process, two processes, and three shards that are merged print the same JSON."""
    whole = _power()
    assert _power("--workers", 2) == whole
    records = [tmp_path / f"{part}.jsonl" for part in range(3)]
    for (part, record), rest in zip(enumerate(records, start=1), (5, 5, 6), strict=True):
        unfinished = json.loads(_power("--shard", f"{part}/3", "--out", record))["unfinished"]
        assert unfinished == rest
    two = _COMMAND.run("merge", *records[:2])
    assert two.exit_code == INCOMPLETE
    assert two.stdout.startswith("SIMULATED, UNFINISHED")
    assert "missing: 2 parts. To finish, run --shard 3/3, and merge all parts" in two.stdout
    merged = _COMMAND.run("merge", *records, "--json")
    assert merged.stdout == whole
    curve = json.loads(whole)
    assert curve["simulated"] is True
    assert [point["n"] for point in curve["power"]] == [8, 12]
    assert all(point["low"] <= point["power"] <= point["high"] for point in curve["power"])
    assert curve["assumptions"][0]["source"] == "assumed"


def test_a_killed_run_resumes(tmp_path: Path) -> None:
    """A record that ends in the middle of a line is continued, and ends with the same curve."""
    record = tmp_path / "record.jsonl"
    whole = _power("--out", record)
    lines = record.read_text(encoding="utf-8").splitlines(keepends=True)
    killed = "".join(lines[:4]) + lines[4][:40]
    record.write_text(killed, encoding="utf-8")
    assert _power("--out", record) == whole
    assert record.read_text(encoding="utf-8") == "".join(lines)


def test_the_text_marks_itself_and_states_assumptions() -> None:
    """People read that it is simulated, what is assumed, and whether anybody preregistered it."""
    result = _COMMAND.run("power", _STUDY, "--participants", "6", "--sets", "20")
    assert result.stdout.startswith("SIMULATED: the power of the test that might be declared")
    assert "answering.effects.latency_350: -1.2 logits (assumed)" in result.stdout
    assert "% of those who start are not in the test. As assumed, they stop, 0.01" in result.stdout
    assert "straight-lined forms, 0.02 of all forms" in result.stdout
    assert "processor time" in result.stderr
    own = _COMMAND.run("power", "four-latencies-williams", "--participants", "6", "--sets", "20")
    assert own.stdout.startswith("SIMULATED: the power of the preregistered test")
    # It declares no rule on straight-lined forms, so nobody is lost for one.
    (lost,) = [line for line in own.stdout.splitlines() if "are not in the test" in line]
    assert "straight-lined" not in lost


def test_power_is_not_given_where_nobody_finishes(tmp_path: Path) -> None:
    """If no data set can be analysed, one sentence says so, and power and level are dashes."""
    shipped = study_configs_dir() / "assumptions" / f"{_STUDY}.yaml"
    text = shipped.read_text(encoding="utf-8")
    own = tmp_path / "assumptions.yaml"
    own.write_text(text.replace("dropout: {value: 0.01", "dropout: {value: 0.99"), encoding="utf-8")
    printed = _COMMAND.run(
        "power", _STUDY, "--participants", "4", "--sets", "10", "--assumptions", own
    ).stdout
    assert "With n of 4 no data set could be analysed" in printed
    assert "failed: data sets on which the test could not be computed, of 10 with" in printed
    (row,) = (line.split() for line in printed.splitlines() if line.startswith("     4 "))
    assert row[2:] == ["-"] * 6 + ["20"]


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("power", "nothing"), "there are: four-latencies-williams"),
        (("power", _STUDY, "--participants", "twelve"), "give numbers, as in 12 or 8,12,16"),
        (("power", _STUDY, "--participants", "1"), "2 to 1000 are valid"),
        (("power", _STUDY, "--sets", "0"), "1 to 100000 are valid"),
        (("power", _STUDY, "--target", "80"), "a power between 0 and 1"),
        (("power", _STUDY, "--shard", "4/3"), "1/3, 2/3 and 3/3"),
        (("power", _STUDY, "--shard", "1/3"), "--shard needs --out"),
        (("power", _STUDY, "--workers", "0"), "1 to 64 are valid"),
        (("power", _STUDY, "--assumptions", "none.yaml"), "there is no file none.yaml in "),
        (("power", "two-latencies-hand"), "docs/pilot.md"),
    ],
)
def test_unusable_input_is_refused(arguments: tuple[str, ...], said: str) -> None:
    """What cannot be computed is refused, with what is valid or what to do."""
    assert said in _COMMAND.refusal(*arguments)


def test_records_of_different_pilots_are_not_mixed(tmp_path: Path) -> None:
    """A record of another seed is refused by name, to resume and to merge; so is no record."""
    first, second = tmp_path / "first.jsonl", tmp_path / "second.jsonl"
    small = ("--participants", "4", "--sets", "5")
    for seed, record in ((1, first), (2, second)):
        _COMMAND.run("power", _STUDY, *small, "--seed", seed, "--out", record)
    assert "differs in assumed_difference, seed" in _COMMAND.refusal("merge", first, second)
    again = _COMMAND.refusal("power", _STUDY, *small, "--seed", 1, "--out", second)
    assert "seed" in again
    (tmp_path / "text.jsonl").write_text("hello\n", encoding="utf-8")
    assert "no record of a pilot" in _COMMAND.refusal("merge", tmp_path / "text.jsonl")
    cohort = tmp_path / "cohort.jsonl"
    cohort.write_text('{"format": 1, "kind": "cohort"}\n{"number": 1}\n', encoding="utf-8")
    told = _COMMAND.refusal("power", _STUDY, *small, "--out", cohort)
    assert "it is the record of a cohort, and not of a power curve; name another file" in told


def test_a_file_of_assumptions_to_copy_is_printed(tmp_path: Path) -> None:
    """The product's file or an example is printed, and can be given again as it is."""
    shipped = study_configs_dir() / "assumptions" / f"{_STUDY}.yaml"
    assert _COMMAND.run("assumptions", _STUDY).stdout == shipped.read_text(encoding="utf-8")
    own = tmp_path / "own.yaml"
    own.write_text(_COMMAND.run("assumptions", "two-latencies-hand").stdout, encoding="utf-8")
    small = ("--participants", "4", "--sets", "5", "--assumptions", own)
    assert _COMMAND.run("power", "two-latencies-hand", *small).exit_code == 0


def test_a_shipped_study_goes_by_its_key_too() -> None:
    """What reports print can be typed again: the key, or the name of the file."""
    by_key, by_name = (
        _COMMAND.run("assumptions", name).stdout
        for name in ("four-latencies", "four-latencies-williams")
    )
    assert by_key == by_name != ""


def test_the_help_shows_a_study_in_place_of_a_command() -> None:
    """The usage has `pilot STUDY`, the most frequent form."""
    assert "STUDY | COMMAND" in _COMMAND.run("--help").stdout
