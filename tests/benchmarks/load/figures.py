"""Compute the figures of a run, each with its limit."""

import numpy as np
from numpy.typing import NDArray

from app.features.record.telemetry.live import PERIOD_S
from app.wire import StreamName
from app.wire.batch import BODY_JOINTS
from tests.benchmarks.load.record import STREAMS
from tests.benchmarks.load.scenario import Outcome
from tests.benchmarks.load.streaming import FRAMES_PER_BATCH, batch_of
from tests.benchmarks.report import Figure

ACK_LIMIT_MS, CONSOLE_LIMIT_MS = 200.0, 150.0
ACTUAL = STREAMS.index(StreamName.ACTUAL.value)
MIB = 2.0**20


def load_figures(part: str, outcome: Outcome) -> list[Figure]:
    """Return all figures of a run of one load."""
    return [
        *acknowledgement(part, outcome),
        *consoles(part, outcome),
        *safety(part, outcome),
        *server(part, outcome),
        *storage(part, outcome),
        *generators(part, outcome),
    ]


def acknowledgement(part: str, outcome: Outcome) -> list[Figure]:
    """Return the time from passing a message to the client until its acknowledgement."""
    load, waits_ms = outcome.load, ack_ms(outcome)
    p50, p99, most = np.percentile(waits_ms, [50, 99, 100])
    real = outcome.messages[:, 0] >= load.sessions - load.real
    words = f"{load.sessions} sessions x 22 joints x 90 Hz x 2 streams, {load.duration_s:g} s"
    found = [
        Figure(part, f"durable ack p50, {words}", p50, "ms"),
        Figure(part, "durable ack p99", p99, "ms", "limit", ACK_LIMIT_MS),
        Figure(part, "durable ack max", most, "ms"),
    ]
    if real.any():
        real_ms = ack_ms(outcome, real)
        name = f"durable ack p99 of {load.real} sessions with the product's client"
        found.append(Figure(part, name, float(np.percentile(real_ms, 99)), "ms", "p99", p99))
    return found


def ack_ms(outcome: Outcome, chosen: NDArray[np.bool_] | None = None) -> NDArray[np.float64]:
    """Return waits (ms); a message without acknowledgement waited until the end of the run."""
    rows = outcome.messages if chosen is None else outcome.messages[chosen]
    longest_s = np.nanmax(outcome.messages[:, 2] + np.nan_to_num(outcome.messages[:, 3]))
    never = np.isnan(rows[:, 3])
    waited_ms: NDArray[np.float64] = np.where(never, longest_s - rows[:, 2], rows[:, 3]) * 1000
    return waited_ms


def consoles(part: str, outcome: Outcome) -> list[Figure]:
    """Return the age of live figures on arrival, and how long a page waits for its session."""
    if not outcome.load.consoles:
        return []
    ages_ms = live_age_ms(outcome)
    views_ms = outcome.views[:, 1] * 1000
    words = f"{outcome.load.consoles} consoles open"
    return [
        Figure(
            part,
            f"console: age of live figures p95, {words}",
            float(np.percentile(ages_ms, 95)),
            "ms",
            "limit",
            CONSOLE_LIMIT_MS,
        ),
        Figure(part, "console: age of live figures max", float(ages_ms.max()), "ms"),
        Figure(
            part,
            "console: session view p95",
            float(np.percentile(views_ms, 95)),
            "ms",
            "limit",
            CONSOLE_LIMIT_MS,
        ),
        Figure(part, "console: session view max", float(views_ms.max()), "ms"),
        Figure(
            part,
            "console: live events",
            len(ages_ms) / outcome.load.duration_s / outcome.load.consoles,
            "1/s each",
            "at most",
            1.0 / PERIOD_S,
        ),
    ]


def live_age_ms(outcome: Outcome) -> NDArray[np.float64]:
    """Return the time from passing a batch to the client until its newest frame is shown."""
    handed_s = {
        number: outcome.messages[
            (outcome.messages[:, 0] == number) & (outcome.messages[:, 1] == ACTUAL), 2
        ]
        for number in np.unique(outcome.news[:, 0])
    }
    ages_s = [
        arrived_s - handed_s[number][batch_of(client_t_s)]
        for number, client_t_s, arrived_s in outcome.news
    ]
    return np.array(ages_s) * 1000


def safety(part: str, outcome: Outcome) -> list[Figure]:
    """Compare the acknowledged data with the stored data."""
    found = outcome.verdict
    told = [session for one in outcome.told.values() for session in one["sessions"]]
    failed = sum(session["failure"] is not None for session in told)
    return [
        Figure(
            part, "frames and reports acknowledged", found.acked, "", "handed over", found.handed
        ),
        Figure(part, "acknowledged and lost", found.lost, ""),
        Figure(part, "stored twice", found.duplicated, ""),
        Figure(part, "stored and never sent", found.surplus, ""),
        Figure(part, "streams not bit-exact", found.differing, "", "compared", found.digested),
        Figure(part, "connections that failed", failed, ""),
        Figure(part, "alarms raised", found.alarms, ""),
    ]


def server(part: str, outcome: Outcome) -> list[Figure]:
    """Return processor time and memory of the server, including its database's processes."""
    watch, load = outcome.watch, outcome.load
    rss_mib, cores = watch.rss_mib(), watch.cpu_share()
    warm_up_s = min(60.0, load.duration_s / 3)
    late = rss_mib[int(warm_up_s) :]
    rate = samples_per_s(outcome)
    others = sum(one.cpu_share() for one in outcome.beside.values())
    return [
        Figure(part, "joint samples", rate, "1/s"),
        Figure(part, "server CPU", 100 * cores, "% of a core"),
        Figure(part, "joint samples per server core", rate / (cores + others), "1/s"),
        Figure(part, f"server memory after {warm_up_s:g} s", float(late[0]), "MiB"),
        Figure(part, "server memory at the end", float(late[-1]), "MiB"),
        Figure(part, "server memory slope", watch.rss_slope_mib_per_h(warm_up_s), "MiB/h"),
        *(
            [Figure(part, "write-ahead log max", watch.wal_max_mib(), "MiB")]
            if watch.database is not None
            else []
        ),
        *(
            Figure(part, f"{name} CPU", 100 * one.cpu_share(), "% of a core")
            for name, one in outcome.beside.items()
        ),
    ]


def samples_per_s(outcome: Outcome) -> float:
    """Return the number of rotations of one joint in one stream stored per second of load."""
    rows = outcome.messages[outcome.messages[:, 1] <= ACTUAL]
    in_time = rows[:, 2] + rows[:, 3] <= outcome.begin_s + outcome.load.duration_s
    frames = int(in_time.sum()) * FRAMES_PER_BATCH
    return frames * BODY_JOINTS / outcome.load.duration_s


def storage(part: str, outcome: Outcome) -> list[Figure]:
    """Return the size of the stored data on disk."""
    found, load = outcome.verdict, outcome.load
    session_minutes = load.sessions * load.duration_s / 60
    # Two streams of 90 Hz; data that are not folded yet do not count.
    frames_per_minute = 2 * 90 * 60
    per_frame = found.chunk_bytes / max(1, found.chunk_frames)
    return [
        Figure(
            part, "stored per session-minute, folded", per_frame * frames_per_minute / MIB, "MiB"
        ),
        Figure(part, "batches not folded at the end", found.batches_left, ""),
        Figure(
            part,
            "database file per session-minute",
            outcome.database_bytes / MIB / session_minutes,
            "MiB",
        ),
    ]


def generators(part: str, outcome: Outcome) -> list[Figure]:
    """Return whether the load itself kept up."""
    figures = []
    for name, told in outcome.told.items():
        share = 100 * told["cpu_s"] / outcome.load.duration_s
        lag_ms = told["lag_s"]["p99"] * 1000
        figures += [
            Figure(part, f"generator ({name} clients) CPU", share, "% of a core"),
            Figure(part, f"generator ({name} clients) lag p99", lag_ms, "ms"),
        ]
    share = 100 * outcome.consoles_cpu_s / outcome.load.duration_s
    return [*figures, Figure(part, "consoles CPU", share, "% of a core")]
