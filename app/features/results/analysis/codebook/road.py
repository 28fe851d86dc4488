"""The columns of road_crossings.csv."""

from app.features.results.analysis.codebook.column import (
    Column,
    Describe,
    phase_columns,
    session_columns,
)

_R = Describe("road_crossings")

ROAD_CROSSINGS: tuple[Column, ...] = (
    *session_columns("road_crossings"),
    *phase_columns("road_crossings"),
    _R.integer(
        "run_part",
        "Which run of the road in this phase; a page that is loaded again begins another.",
        levels="1 and up",
    ),
    _R.integer("number", "Which crossing of the run.", levels="1 and up"),
    _R.number(
        "steps_on_s",
        "When they stepped onto the carriageway, in active time of the phase; empty if never.",
        "s",
        "0 and up",
    ),
    _R.number(
        "steps_off_s",
        "When they stepped behind a kerb again, in active time; empty if the run ended before.",
        "s",
        "0 and up",
    ),
    _R.boolean("is_across", "Whether that was the other kerb; false for somebody who turned back."),
    _R.number(
        "waited_s",
        "Time stood within 1.5 m of the kerb before stepping onto the carriageway.",
        "s",
        "0 and up",
    ),
    _R.number(
        "gap_accepted_s",
        "At steps_on_s, time until the first car would be at the participant's line with the speed "
        "it had (Oxley et al. 2005); empty if no car was coming, or it stood.",
        "s",
        "0 and up",
    ),
    _R.text(
        "gaps_refused_s",
        "Times between successive cars at that line while the participant waited, s, separated by "
        "spaces.",
    ),
    _R.integer("refused", "How many gaps were refused.", levels="0 and up"),
    _R.number(
        "least_time_to_collision_s",
        "Smallest time to collision on the carriageway, if both kept speed and heading (Hayward "
        "1972); empty without a collision course.",
        "s",
        "0 and up",
    ),
    _R.number(
        "least_post_encroachment_s",
        "Smallest time between one leaving the area that both use and the other reaching it "
        "(Allen, Shin and Cooper 1978); empty if no car used the participant's line.",
        "s",
        "0 and up",
    ),
    _R.number(
        "closest_m", "Smallest distance to a car on the carriageway, 0 if hit.", "m", "0 and up"
    ),
    _R.boolean("collision", "Whether the outlines of participant and a car overlapped."),
    _R.text("collision_car", "The car of the first overlap."),
    _R.number("collision_s", "When it was, in active time.", "s", "0 and up"),
    _R.number("collision_speed_m_s", "How fast that car was.", "m/s", "0 and up"),
    _R.integer("traffic_seed", "Seed of the run's traffic.", levels="0 and up"),
    _R.text(
        "run_ended",
        "How the run ended.",
        "running, complete, partner lost, interrupted",
    ),
    _R.text("run_problem", "Why it broke off; empty if it did not."),
    _R.integer(
        "run_guesses",
        "How many states of the run were extrapolated, because a partner was late.",
        levels="0 and up",
    ),
    _R.number(
        "run_worst_guess_m",
        "Largest distance between such a state and what the partner said later.",
        "m",
        "0 and up",
    ),
    _R.text("record_sha256", "SHA-256 of the run's record, the file in road/."),
)
