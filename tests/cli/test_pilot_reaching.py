"""Tests of `reembody pilot --reaching`: hands that move as recorded, and who says so."""

import json
import re
from pathlib import Path
from typing import Any

import pytest

from app.adapters.reaching_file import read_reaching, write_reaching
from app.cli.pilot.run import CohortOptions, carry_out_cohort
from app.features.results.pilot.simulation import Cohort, CohortOrder, Sharing
from tests.cli.invoked import Invoked
from tests.protocol.helpers import CONFIGS
from tests.science.reaching.test_model import fit_to, reaches_by

_COMMAND = Invoked("pilot")
_PEOPLE = ("--participants", 3, "--seed", 5)


@pytest.fixture(scope="module")
def lab(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with a short hand study, and files of slow and of quick people."""
    folder = tmp_path_factory.mktemp("pilot")
    text = (CONFIGS / "templates" / "two-latencies-hand.yaml").read_text(encoding="utf-8")
    text = re.sub(r"duration_s: 60", "duration_s: 8", text)
    text = re.sub(r"avatar: physics\navatar_configuration: .*", "avatar: delayed_copy", text)
    (folder / "study.yaml").write_text(text, encoding="utf-8")
    for name, tempos in (("slow", (2.4, 2.6)), ("quick", (0.8, 0.9))):
        write_reaching(folder / f"{name}.npz", fit_to(reaches_by(tempos, 12)))
    return folder


@pytest.fixture(scope="module")
def whole(lab: Path) -> tuple[Path, dict[str, Any]]:
    """Return the record and the report of a cohort of slow people, simulated in this process."""
    record = lab / "whole.jsonl"
    return record, _COMMAND.figures(
        lab / "study.yaml", *_PEOPLE, "--reaching", lab / "slow.npz", "--out", record
    )


def _simulated(
    lab: Path, name: str, out: str, *, workers: int = 1, shard: tuple[int, int] = (0, 1)
) -> tuple[Path, Cohort]:
    order = CohortOrder(3, 5, None, read_reaching(lab / f"{name}.npz"))
    options = CohortOptions(str(lab / "study.yaml"), order, Sharing(workers, shard), lab / out)
    return lab / out, carry_out_cohort(options, lambda _: None)[1]


def test_the_same_bytes_however_it_is_shared_out(
    lab: Path, whole: tuple[Path, dict[str, Any]]
) -> None:
    """Two processes write the same record, and three shards merge to the same report."""
    record, report = whole
    assert _simulated(lab, "slow", "two.jsonl", workers=2)[0].read_bytes() == record.read_bytes()
    shards = [_simulated(lab, "slow", f"{part}.jsonl", shard=(part, 3))[0] for part in range(3)]
    merged = _COMMAND.figures("merge", *shards, "--study", lab / "study.yaml")
    assert merged | {"real_time_factor": 0} == report | {"real_time_factor": 0}


def test_shards_with_different_files_are_not_merged(lab: Path) -> None:
    """People who reach as others do are another cohort, and so are those with the constants."""
    slow, _ = _simulated(lab, "slow", "slow1.jsonl", shard=(0, 2))
    quick, _ = _simulated(lab, "quick", "quick2.jsonl", shard=(1, 2))
    order = CohortOrder(3, 5)
    options = CohortOptions(str(lab / "study.yaml"), order, Sharing(1, (1, 2)), lab / "none.jsonl")
    carry_out_cohort(options, lambda _: None)
    for other in (quick, lab / "none.jsonl"):
        said = _COMMAND.refusal("merge", slow, other, "--study", lab / "study.yaml")
        assert "it differs in reaching" in said


def test_the_report_names_the_file_and_what_it_was_fitted_on(
    lab: Path, whole: tuple[Path, dict[str, Any]]
) -> None:
    """Hash, people, reaches and that they are synthetic stand in report, assumptions and forms."""
    record, report = whole
    digest = read_reaching(lab / "slow.npz").content_hash
    found = report["reaching"]
    assert (found["sha256"], found["people"], found["reaches"]) == (digest, 2, found["synthetic"])
    assert found["movements"] > 0
    (tempo, between) = report["assumptions"]
    assert tempo["name"] == "reaching.tempo"
    assert tempo["value"] == pytest.approx(2.5, rel=0.06)
    assert between["name"] == "reaching.between_people"
    assert all(digest in one["source"] and "SYNTHETIC" in one["source"] for one in (tempo, between))
    assert digest in report["paragraphs"]["ethics"]
    assert json.loads(record.read_text().splitlines()[0])["reaching"]["sha256"] == digest


def test_slow_people_complete_less_than_quick_ones(lab: Path) -> None:
    """What was learnt of hands shows in what they do."""
    done = {
        name: sum(
            phase.completions
            for visit in _simulated(lab, name, f"all-{name}.jsonl")[1].visits
            for phase in visit.phases
        )
        for name in ("slow", "quick")
    }
    assert done["slow"] < done["quick"]


def test_movements_over_distances_that_were_not_recorded_are_counted(lab: Path) -> None:
    """The printed report says of how many movements the time is a guess."""
    near = fit_to([one for one in reaches_by((1.0, 1.2), 30) if one.distance_m < 0.25])
    write_reaching(lab / "near.npz", near)
    said = _COMMAND.run(lab / "study.yaml", *_PEOPLE, "--reaching", lab / "near.npz").stdout
    assert re.search(r"[1-9]\d* of \d+ movements were over a distance outside", said)


def test_without_a_file_nothing_of_it_is_in_record_or_report(lab: Path) -> None:
    """A cohort with the constants has the record and the hash that it always had."""
    record = lab / "constants.jsonl"
    report = _COMMAND.figures(lab / "study.yaml", *_PEOPLE, "--out", record)
    assert "reaching" not in report
    assert "reach" not in record.read_text().replace("reach_", "")


def test_a_damaged_file_is_refused_before_the_work(lab: Path) -> None:
    """Half a file is refused, with the command that writes a whole one."""
    half = lab / "half.npz"
    half.write_bytes((lab / "slow.npz").read_bytes()[:2000])
    assert "`./run reach fit` writes one" in _COMMAND.refusal(
        lab / "study.yaml", *_PEOPLE, "--reaching", half
    )
