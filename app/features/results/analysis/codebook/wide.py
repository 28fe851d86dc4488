"""The columns of wide.csv before its values, and of wide_columns.csv, which describes these."""

from app.features.results.analysis.codebook.column import Column, Describe

_W = Describe("wide")
_C = Describe("wide_columns")

WIDE: tuple[Column, ...] = (
    _W.text("participant_code", "Pseudonym, unique within the study and kind."),
    _W.text("kind", "Who took part.", "people, simulated, test"),
    _W.boolean("simulated", "Whether a simulation made the data."),
    _W.text(
        "avatar",
        "How the body that the participant saw was moved.",
        "delayed_copy, physics",
    ),
    _W.text("order", "Conditions in the order of the blocks, as in sessions."),
)
WIDE_COLUMNS: tuple[Column, ...] = (
    _C.text("name", "Name of the column in wide.csv, as JASP and SPSS take it."),
    _C.text("measure", "The score or measure, in words."),
    _C.text("limb", "The task's limb.", "hand, foot"),
    _C.text("condition", "The condition, and the body where conditions differ in their bodies."),
    _C.text("unit", "Unit of the values, if they have one."),
    _C.text("about", "What the measure is, and its range."),
)
