"""Tests that a power loss at any moment loses no acknowledged data and leaves a sound database.

Faults 2 and 3 of the matrix, and the proof that an acknowledgement is sent only after the flush
that makes it true. `tests.faults.power` describes what the emulated disk does and does not do.
"""

import sys
from collections import Counter
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
import pytest

from tests.faults.power import experiment
from tests.faults.power.disk import MOODS
from tests.faults.power.experiment import AckProof, Crash, Recording
from tests.faults.tracing.running import why_not
from tests.support.server import REEMBODY

EMULATED = (
    "emulated: a disk that keeps what an fsync covered; of later writes any sector (512 or 4096 "
    "bytes) in any\norder, torn; sizes, names and unwritten sectors (zeros, noise) as they come; "
    "no -shm, or noise in it\nnot emulated: a disk that lies about fsync or damages sectors nobody "
    "wrote to"
)
MOST_S = 64.0
PLACES = 7
"""The number of kinds of moments at which power fails."""


@pytest.fixture(scope="module")
def can_trace(tmp_path_factory: pytest.TempPathFactory) -> None:
    """Skip if the kernel does not let a process trace its child."""
    reason = why_not(tmp_path_factory.mktemp("tracing"))
    if reason is not None:
        pytest.skip(reason)


@pytest.fixture(scope="module")
def recording(can_trace: None, tmp_path_factory: pytest.TempPathFactory) -> Recording:
    """Provide a recording of three headsets, from the server's first start to its end."""
    folder = tmp_path_factory.mktemp("power")
    return streamed(folder, 3, lambda proof: proof.acks > 80, (100, 200))


def test_no_ack_is_sent_before_its_flush(
    recording: Recording, capsys: pytest.CaptureFixture[str]
) -> None:
    """The data of every acknowledgement are covered by a completed fsync when its send begins."""
    proof = experiment.prove_acks(recording)
    with capsys.disabled():
        sys.stdout.write(ack_figures(proof))
    assert proof.acks > 50
    assert proof.early == 0


def test_no_power_loss_loses_acknowledged_data(
    recording: Recording, capsys: pytest.CaptureFixture[str]
) -> None:
    """A power loss around any kind of call, in any mood of the disk, loses nothing acknowledged."""
    crashes = crash(recording, PLACES * len(MOODS), seed=1)
    with capsys.disabled():
        sys.stdout.write(crash_figures(crashes))
    check(crashes)


@pytest.mark.long
@pytest.mark.timeout(3600)
def test_a_thousand_power_losses_lose_nothing(
    can_trace: None, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A thousand power losses in a run with several checkpoints lose nothing acknowledged."""
    recording = experiment.record_streaming(tmp_path / "run", 4, 25.0)
    proof = experiment.prove_acks(recording)
    crashes = crash(recording, 1000, seed=2)
    with capsys.disabled():
        sys.stdout.write(ack_figures(proof) + crash_figures(crashes))
    assert proof.early == 0
    check(crashes)


def test_the_check_detects_acks_before_their_flush(recording: Recording) -> None:
    """The check finds lost data if every acknowledgement is moved before its flush."""
    careless = recording.with_earlier_acks()
    assert experiment.prove_acks(careless).early > 50
    crashes = crash(careless, 2 * PLACES, seed=1)
    assert sum(one.verdict.lost for one in crashes) > 0


@pytest.mark.parametrize("level", ["NORMAL", pytest.param("OFF", marks=pytest.mark.long)])
def test_the_check_detects_a_database_that_does_not_flush(
    can_trace: None, tmp_path: Path, level: str
) -> None:
    """The check finds lost data of a real server with `synchronous` below FULL."""
    command = [sys.executable, "-m", "tests.faults.weakened", level]
    recording = streamed(
        tmp_path, 2, lambda proof: proof.early > 20, (40, 80, 160), command=command
    )
    assert experiment.prove_acks(recording).early > 20
    crashes = crash(recording, 2 * PLACES, seed=1)
    assert sum(one.verdict.lost for one in crashes) > 0


def streamed(
    folder: Path,
    headsets: int,
    is_enough: Callable[[AckProof], bool],
    acks: Sequence[int],
    *,
    command: Sequence[str] = REEMBODY,
) -> Recording:
    """Return the first recording with what is wanted, of about so many acknowledgements each.

    A traced server on a busy machine takes a while until it acknowledges anything, and a recording
    that goes on meanwhile takes as long again to examine.
    """
    for most_acks in acks:
        place = folder / f"{most_acks} acks"
        recording = experiment.record_streaming(
            place, headsets, MOST_S, command, most_acks=most_acks
        )
        if is_enough(experiment.prove_acks(recording)):
            break
    return recording


def crash(recording: Recording, count: int, seed: int) -> list[Crash]:
    """Emulate `count` power losses, around every kind of call and in every mood of the disk."""
    rng = np.random.default_rng(seed)
    return experiment.crash_at(recording, experiment.draw_crash_points(recording, count, rng), rng)


def check(crashes: Sequence[Crash]) -> None:
    """Assert that no data are lost, altered, duplicated or torn, and that all moods were tried."""
    for one in crashes:
        verdict = one.verdict
        assert verdict.corrupt == "", one
        assert (verdict.lost, verdict.altered, verdict.duplicated, verdict.holes) == (0, 0, 0, 0), (
            one
        )
    assert {one.point.mood for one in crashes} == set(MOODS)
    assert sum(one.promised > 0 for one in crashes) > len(crashes) / 3


def ack_figures(proof: AckProof) -> str:
    """Format the comparison of acknowledgements with flushes in one line."""
    half, most = np.percentile(proof.waits_ms, [50, 99])
    return (
        f"\nacks {proof.acks}, flushes {proof.syncs}, acks before their flush {proof.early}; "
        f"from flush to ack p50 {half:.2f} ms, p99 {most:.2f} ms\n"
    )


def crash_figures(crashes: Sequence[Crash]) -> str:
    """Format the power losses as a table by place."""
    lines = [
        "",
        f"{'power fails':<18}{'points':>7}{'acked':>10}{'lost':>6}{'twice':>6}{'corrupt':>8}",
    ]
    places = Counter(one.point.where for one in crashes)
    for where in [*sorted(places), "all"]:
        those = [one for one in crashes if where in (one.point.where, "all")]
        verdicts = [one.verdict for one in those]
        counts = (
            len(those),
            sum(one.promised for one in those),
            sum(verdict.lost for verdict in verdicts),
            sum(verdict.duplicated for verdict in verdicts),
            sum(bool(verdict.corrupt) for verdict in verdicts),
        )
        widths = (7, 10, 6, 6, 8)
        cells = (f"{n:>{width}}" for n, width in zip(counts, widths, strict=True))
        lines.append(f"{where:<18}" + "".join(cells))
    return "\n".join([*lines, EMULATED, ""])
