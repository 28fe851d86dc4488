"""The columns of the equipment's tables (clocks, calibrations, self-tests) and mapped times."""

from app.features.results.analysis.codebook.column import Column, Describe, session_columns

_P = Describe("clock_probes")
_M = Describe("clock_mapping")
_C = Describe("calibrations")
_T = Describe("headset_tests")
CALIBRATIONS: tuple[Column, ...] = (
    _C.text("equipment", "What was measured: headset, tracking and computer together."),
    _C.number(
        "motion_to_photon_ms",
        "Mean delay of the equipment itself, from a movement to its picture. latency_ms of the "
        "other tables comes on top of it.",
        "ms",
        "above 0",
    ),
    _C.number("sd_ms", "Standard deviation over the single measurements.", "ms", "0 and up"),
    _C.integer("samples", "How many single measurements there were.", levels="1 and up"),
    _C.text("method", "How it was measured."),
    _C.text("measured_on", "The day of the measurement.", "ISO 8601 date"),
    _C.boolean("current", "Whether it is the newest of its equipment that was not retired."),
    _C.text("note", "What else was written down."),
    _C.time("recorded_at_utc", "When it was entered."),
    _C.time("retired_at_utc", "When it was marked as a mistake."),
    _C.text("retired_reason", "Why it was."),
)
HEADSET_TESTS: tuple[Column, ...] = (
    _T.text("self_test_id", "Identifies the self-test."),
    _T.time("started_at_utc", "When it began, by the headset's clock."),
    _T.time("received_at_utc", "When its report arrived, by the server's clock."),
    _T.number(
        "clock_ahead_s",
        "How far the headset's clock was ahead of the server's at least, because a report cannot "
        "arrive before its test has ended; empty up to a minute.",
        "s",
        "above 60",
    ),
    _T.text("device", "Name of the device, if its browser tells."),
    _T.text("user_agent", "How the browser describes itself."),
    _T.text(
        "inputs",
        "What moved the body, separated by spaces.",
        "controllers, hands, body, shins, trackers, desktop, scripted",
    ),
    _T.boolean("worn", "Whether it was shown in a headset and moved by a person."),
    _T.text("rendering_mode", "Where it was shown.", "immersive, screen"),
    _T.text("physics_where", "Where the body was computed.", "worker, page"),
    _T.text("model_hash", "Hash of the body's model that was simulated."),
    _T.text("errors", "Errors that the page caught."),
    _T.text(
        "figure",
        "What the row is about: verdict. and its code for what is judged; otherwise its place in "
        "the report.",
    ),
    _T.number("value", "Its value; empty if it was not measured.", "as unit says"),
    _T.text(
        "unit", "The unit of value and limit; empty for a plain number.", "s, Hz, %, B, B/s, m"
    ),
    _T.text("status", "The verdict; empty for figures that are not judged.", "ok, warn, fail"),
    _T.number("limit", "The worst value that is still ok.", "as unit says"),
    _T.boolean("at_least", "Whether value has to be at least limit, or else at most."),
)


def epoch_column(table: str) -> Column:
    """Return the column of the client's run, which identifies the clock of the row's times."""
    return Describe(table).integer(
        "epoch",
        "Run of the client: a restart takes a new one, with a new clock.",
        levels="1 and up",
    )


def mapped_columns(table: str, name: str, what: str) -> tuple[Column, ...]:
    """Return the columns of a client time mapped to UTC and of its uncertainty."""
    of = Describe(table)
    return (
        of.time(
            name,
            f"{what}, brought to the server's clock by the probes; take lengths from the client's "
            "seconds. Empty without a probe in that run.",
        ),
        of.number(
            "clock_uncertainty_ms",
            f"How far {name} can be off either way, whatever the network's two ways took, as long "
            "as the clocks drift evenly for minutes. UTC itself is as right as the server's clock.",
            "ms",
            "0 and up",
        ),
    )


CLOCK_PROBES: tuple[Column, ...] = (
    *session_columns("clock_probes"),
    epoch_column("clock_probes"),
    _P.number("client_sent_s", "When the client asked, on its monotonic clock.", "s"),
    _P.number("server_received_s", "When the server read it, on its monotonic clock.", "s"),
    _P.number("server_sent_s", "When the server answered, on its monotonic clock.", "s"),
    _P.number("client_received_s", "When the answer came, on the client's clock.", "s"),
    _P.time("server_utc", "The server's wall clock when it stored the reading."),
    _P.number(
        "round_trip_ms",
        "Time under way: the client's waiting less the server's handling. Below 0 it cannot be "
        "true, and the probe is left out.",
        "ms",
    ),
    _P.number(
        "offset_s", "Server's clock minus client's, had both ways taken as long as the other.", "s"
    ),
    _P.boolean("timed_out", "Whether no answer came within 2 s; the times behind are empty."),
)


CLOCK_MAPPING: tuple[Column, ...] = (
    *session_columns("clock_mapping"),
    epoch_column("clock_mapping"),
    _M.integer("segment", "Place among the run's segments of a few minutes.", levels="1 and up"),
    _M.number("from_s", "Begin on the client's clock.", "s"),
    _M.number("to_s", "End on the client's clock.", "s"),
    _M.time(
        "from_utc",
        "The same moment as from_s. Any of the client's times between, as of samples, lies between "
        "from_utc and to_utc in proportion.",
    ),
    _M.time("to_utc", "The same moment as to_s."),
    _M.number("offset_s", "Server's monotonic clock minus the client's, at from_s.", "s"),
    _M.number("drift_ppm", "How much faster the server's clock runs.", "ppm", "from -500 to 500"),
    _M.number("min_round_trip_ms", "Shortest round trip.", "ms", "0 and up"),
    _M.number("uncertainty_ms", "Largest uncertainty of a time in it.", "ms", "0 and up"),
    _M.integer("probes", "Probes that it rests on.", levels="1 and up"),
    _M.integer("left_out", "Probes left out because they cannot be true.", levels="0 and up"),
    _M.number(
        "step_ms",
        "Jump of the offset as it was read, between the segment before and this; 0 if none.",
        "ms",
    ),
    _M.text(
        "stepped",
        "Whose clock jumped: the client's (or it stood still, as when a headset sleeps), or the "
        "server's, which is then undone.",
        "client, server",
    ),
    _M.number(
        "server_utc_step_ms",
        "How far the server's wall clock was from the UTC of this record, which is fixed by the "
        "session's first probes. Some tens of milliseconds are the delay of storing.",
        "ms",
    ),
)
