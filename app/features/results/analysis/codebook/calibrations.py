"""The columns of calibrations.csv."""

from app.features.results.analysis.codebook.column import Column, Describe

_C = Describe("calibrations")

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
