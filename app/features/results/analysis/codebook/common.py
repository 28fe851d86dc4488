"""Columns that many tables share, so that they mean the same everywhere."""

from app.features.results.analysis.codebook.column import Column, Describe


def session_columns(table: str) -> tuple[Column, ...]:
    """Whose row it is: the first columns of every table of a study."""
    of = Describe(table)
    return (
        of.text("study_key", "The study."),
        of.integer(
            "study_version", "Version of the study that the session ran.", levels="1 and up"
        ),
        of.text("kind", "Who took part.", "people, simulated, test"),
        of.boolean("simulated", "Whether a simulation made the data."),
        of.text(
            "avatar",
            "How the body that the participant saw was moved.",
            "delayed_copy, physics",
        ),
        of.text("participant_code", "Pseudonym, unique within the study and kind."),
        of.text("session_id", "The visit."),
    )


def place_columns(table: str) -> tuple[Column, ...]:
    """Where in the design a row belongs; all empty outside the blocks."""
    of = Describe(table)
    return (
        of.integer(
            "block",
            "Which block of the session, in the order in which they were done: the period.",
            levels="1 and up",
        ),
        of.integer(
            "position",
            "Place of the phase within its block. Where it always goes with the same limb, limb "
            "and time cannot be told apart.",
            levels="1 and up",
        ),
        of.text("limb", "Which limb the task is done with.", "hand, foot"),
        of.text("condition", "Key of the condition in the study file."),
        of.number(
            "latency_ms",
            "Latency added on top of what the equipment has of its own.",
            "ms",
            "0 and up",
        ),
    )


def phase_columns(table: str) -> tuple[Column, ...]:
    """Which phase a row belongs to, and whether it counts."""
    of = Describe(table)
    return (
        of.integer("phase_id", "The phase within its session.", levels="1 and up"),
        of.text("phase_kind", "What kind of phase.", "free_roam, practice, task"),
        *place_columns(table),
        of.integer(
            "attempt", "Which attempt at the step; redone steps count up.", levels="1 and up"
        ),
        of.boolean(
            "valid",
            "Whether the row may be analysed: the phase was finished and not redone or skipped, "
            "and the session was neither aborted nor withdrawn.",
        ),
    )
