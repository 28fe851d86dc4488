"""The columns of answers.csv, scores.csv and corrections.csv."""

from app.features.results.analysis.codebook.column import (
    Column,
    Describe,
    place_columns,
    session_columns,
)

_A = Describe("answers")
_S = Describe("scores")
_C = Describe("corrections")


_FORM = (
    "Whether the row may be analysed: the form was not superseded by a later attempt, the "
    "phase it asks about was not skipped,"
)


def _form_columns(table: str) -> tuple[Column, ...]:
    of = Describe(table)
    return (
        of.text("submission_id", "The filled-in form."),
        of.text("administration", "Which filling-in: the step and its attempt."),
        of.text("instrument", "Key of the questionnaire."),
        of.integer("instrument_version", "Version of the questionnaire.", levels="1 and up"),
        of.integer("step_index", "Step of the procedure.", levels="0 and up"),
        *place_columns(table),
        of.integer(
            "attempt", "Which attempt at the step; redone steps count up.", levels="1 and up"
        ),
        of.valid(
            f"{_FORM} and the session counts (valid in sessions.csv).",
            f"{_FORM} and the session was neither aborted nor withdrawn.",
        ),
        of.text("mode", "How it was entered.", "tablet, operator"),
    )


ANSWERS: tuple[Column, ...] = (
    *session_columns("answers"),
    *_form_columns("answers"),
    _A.text("language", "Language the form was shown in.", "ISO 639-1 code"),
    _A.text("item", "Key of the item in the questionnaire."),
    _A.text("item_type", "What kind of item.", "likert, integer, number, text, boolean, choice"),
    _A.integer("shown_position", "Place at which the item was shown.", levels="1 and up"),
    _A.number(
        "value_number",
        "The answer as given, or its newest correction, before any recoding; yes is 1 and no is 0. "
        "Empty if left out.",
        "the item's unit",
        "the item's range",
    ),
    _A.text("value_text", "The answer to an open question, or the key of the choice."),
    _A.boolean("corrected", "Whether the answer was corrected; corrections.csv has what it was."),
    _A.number(
        "response_s",
        "Response time: from when the item was the next to be answered (its page was shown, or "
        "another item of the page was answered) to its first answer; of typed answers to the end "
        "of the first writing. Empty if not answered, or from a version that did not measure it.",
        "s",
    ),
    _A.integer(
        "changes",
        "How often the answer was changed after it was given first; of typed answers, how often "
        "the field was returned to. Empty like response_s.",
        levels="0 and up",
    ),
    _A.number(
        "answered_after_s", "From the opening of the form to the last change of the answer.", "s"
    ),
    _A.time("started_at_utc", "When the form was opened, by the tablet's clock."),
    _A.time("submitted_at_utc", "When it was stored."),
)

SCORES: tuple[Column, ...] = (
    *session_columns("scores"),
    *_form_columns("scores"),
    _S.text("score", "Key of the score in the questionnaire."),
    _S.number(
        "value",
        "The score of the answers that count; empty if one of its items was left out.",
        levels="minimum to maximum",
    ),
    _S.number("minimum", "Lowest value that the score can have."),
    _S.number("maximum", "Highest value that the score can have."),
    _S.time("submitted_at_utc", "When the form was stored."),
    _S.text(
        "body",
        "Body that the condition prescribes, by the name that it was given in the lab; empty if "
        "the participant wore the body of the avatar's configuration.",
    ),
)

CORRECTIONS: tuple[Column, ...] = (
    *session_columns("corrections"),
    _C.text("submission_id", "The filled-in form."),
    _C.text("administration", "Which filling-in: the step and its attempt."),
    _C.text("instrument", "Key of the questionnaire."),
    _C.text("item", "Key of the item in the questionnaire."),
    _C.number(
        "previous_number",
        "What counted before; of an item's first correction, the answer as given.",
        "the item's unit",
        "the item's range",
    ),
    _C.text("previous_text", "The same, of an open question or a choice."),
    _C.number(
        "value_number",
        "What counts from here on. Empty if the answer was taken out.",
        "the item's unit",
        "the item's range",
    ),
    _C.text("value_text", "The same, of an open question or a choice."),
    _C.text("reason", "Why, in the lab's words."),
    _C.text("by", "Who corrected it."),
    _C.time("at_utc", "When."),
)
