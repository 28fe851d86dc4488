"""The kinds of steps of a session, each defined in one table.

A step belongs to one of three families. A *timed* step is a phase: the headset runs it on its own
clock, and its movement and contacts are recorded as such. A *form* is answered on the tablet. A
step *by hand* ends when the experimenter, or the participant on the tablet, completes it.

Everything that differs between kinds is a field of `StepKindSpec`, and everything else is derived
from the table: plans, commands, tablet screens, checks of study files, tables and figures. The
pages have the same table, which `python -m app.cli.page_texts` generates.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any, Literal

from app.science.tasks import Limb
from app.texts import LANGUAGES, Words

StepKind = Literal[
    "consent",
    "form",
    "instructions",
    "height",
    "materialise",
    "free_roam",
    "practice",
    "task",
    "road_crossing",
    "questionnaire",
    "debrief",
]
Family = Literal["timed", "form", "by hand"]
StepCommand = Literal["begin_phase", "enter_answers", "complete_step", "materialise"]
"""The commands with which the experimenter carries out a step."""
StepScreen = Literal["consent", "instructions", "form", "waiting"]


@dataclass(frozen=True)
class PhaseWords:
    """The texts of a timed phase, for one limb or for a phase without one.

    `title` is the step's heading, `in_a_sentence` names it within a sentence ("block 2, hand task:
    skipped"), `begin` is the label of the experimenter's button, and `guidance` says what to check
    before it starts.
    """

    title: Words
    in_a_sentence: Words
    begin: Words
    guidance: Words


@dataclass(frozen=True, kw_only=True)
class StepKindSpec:
    """One kind of step.

    Args:
        key: the word in study files, plans, events and tables.
        name: the title of a step, if the study specifies none and no limb is involved.
        icon: one of the pages' icons, whose names are in `frontend/src/shared/ui/Icon.tsx`. A step
            with a limb shows the limb.
        guidance: the guidance for the experimenter while the step is current; None if it is in
            `phases`.
        screen: the screen that the tablet shows during the step.
        command: the command with which the experimenter carries it out; it determines the family.
        done: the label of the button that completes it; None if it has its own form or another
            command.
        takes_s: our estimate of the time that it takes in addition to reading its text, seconds;
            None if the study specifies it, or if there is only reading.
        phases: the texts of a timed kind by limb; the key None stands for a phase without a limb.
        phase_key: for a timed kind, the phase's key in the rules of a study; `{limb}` is replaced.
        counts: whether its phases are the study's data. All others are recorded, but in no figure
            or test.
        needs_body: whether it must come after the step in which the participant gets a body.
        has_road: whether its phases are on the study's road.
        records_movement: whether movement is recorded in it, once the participant has a body.
    """

    key: StepKind
    name: Words
    icon: str
    guidance: Words | None = None
    screen: StepScreen = "waiting"
    command: StepCommand = "complete_step"
    done: Words | None = None
    takes_s: float | None = None
    phases: Mapping[Limb | None, PhaseWords] = field(default_factory=dict)
    phase_key: str | None = None
    counts: bool = False
    needs_body: bool = False
    has_road: bool = False
    records_movement: bool = True

    @property
    def family(self) -> Family:
        """The family of the kind: timed, a form, or done by hand."""
        match self.command:
            case "begin_phase":
                return "timed"
            case "enter_answers":
                return "form"
            case _:
                return "by hand"

    @property
    def has_boxes(self) -> bool:
        """Whether a limb reaches for the boxes of a task."""
        return bool(self.phases) and None not in self.phases

    def title(self, limb: str | None) -> Mapping[str, str]:
        """Return the title, by language, of a step of this kind with `limb`, or without one."""
        phase = next((words for own, words in self.phases.items() if own == limb), None)
        title = self.name if phase is None else phase.title
        return {language: title.in_language(language) for language in LANGUAGES}

    def key_of_phase(self, limb: object) -> str | None:
        """Return the key of this kind's phase in rules (hand, practice_foot); None if untimed."""
        return None if self.phase_key is None else self.phase_key.format(limb=limb)


_TO_TRY = Words(
    "A task to try out; it is not analysed. Let the participant ask questions.",
    "Eine Aufgabe zum Ausprobieren, die nicht ausgewertet wird. Ermuntern Sie zu Fragen.",
)
_BEGIN_PRACTICE = Words("Begin practice", "Übung beginnen")
_FREE_MOVEMENT = Words("Free movement", "Freies Bewegen")
_CROSSING = Words("Crossing the road", "Überqueren der Straße")

_TABLE = (
    StepKindSpec(
        key="consent",
        name=Words("Consent", "Einwilligung"),
        icon="check",
        screen="consent",
        guidance=Words(
            "The participant reads and agrees on the tablet. Record the consent here only if it "
            "was given on paper.",
            "Die Person liest und willigt am Tablet ein. Tragen Sie die Einwilligung hier nur "
            "ein, wenn sie auf Papier gegeben wurde.",
        ),
    ),
    StepKindSpec(
        key="form",
        name=Words("Questions", "Fragen"),
        icon="form",
        screen="form",
        command="enter_answers",
        guidance=Words("The participant answers on the tablet.", "Die Person antwortet am Tablet."),
    ),
    StepKindSpec(
        key="instructions",
        name=Words("Instructions", "Anleitung"),
        icon="talk",
        screen="instructions",
        done=Words("Instructions are clear", "Anleitung ist klar"),
        guidance=Words(
            "The participant reads on the tablet. Invite questions before you continue.",
            "Die Person liest am Tablet. Laden Sie zu Fragen ein, bevor es weitergeht.",
        ),
    ),
    StepKindSpec(
        key="height",
        name=Words("Height", "Körpergröße"),
        icon="height",
        takes_s=60.0,
        guidance=Words(
            "Ask for the height, then match the avatar by eye. Both values are kept.",
            "Fragen Sie nach der Größe und gleichen Sie den Avatar nach Augenmaß an. Beide Werte "
            "bleiben erhalten.",
        ),
    ),
    StepKindSpec(
        key="materialise",
        name=Words("Entering the body", "Eintritt in den Körper"),
        icon="body",
        command="materialise",
        takes_s=60.0,
        guidance=Words(
            "The participant stands inside the transparent body in a T-pose and presses both "
            "grips.",
            "Die Person steht in T-Pose im durchsichtigen Körper und drückt beide Griffe.",
        ),
    ),
    StepKindSpec(
        key="free_roam",
        name=_FREE_MOVEMENT,
        icon="walk",
        command="begin_phase",
        phase_key="free_roam",
        phases={
            None: PhaseWords(
                title=_FREE_MOVEMENT,
                in_a_sentence=Words("free movement", "freies Bewegen"),
                begin=Words("Begin free movement", "Freies Bewegen beginnen"),
                guidance=Words(
                    "Let the participant look around, down at their body and into the mirror.",
                    "Lassen Sie die Person umherschauen, an sich hinab und in den Spiegel.",
                ),
            ),
        },
    ),
    StepKindSpec(
        key="practice",
        name=Words("Practice", "Übung"),
        icon="hand",
        command="begin_phase",
        phase_key="practice_{limb}",
        needs_body=True,
        phases={
            Limb.HAND: PhaseWords(
                title=Words("Practice with the hand", "Übung mit der Hand"),
                in_a_sentence=Words("practice with the hand", "Übung mit der Hand"),
                begin=_BEGIN_PRACTICE,
                guidance=_TO_TRY,
            ),
            Limb.FOOT: PhaseWords(
                title=Words("Practice with the foot", "Übung mit dem Fuß"),
                in_a_sentence=Words("practice with the foot", "Übung mit dem Fuß"),
                begin=_BEGIN_PRACTICE,
                guidance=_TO_TRY,
            ),
        },
    ),
    StepKindSpec(
        key="task",
        name=Words("Task", "Aufgabe"),
        icon="hand",
        command="begin_phase",
        phase_key="{limb}",
        counts=True,
        phases={
            Limb.HAND: PhaseWords(
                title=Words("Hand task", "Handaufgabe"),
                in_a_sentence=Words("hand task", "Handaufgabe"),
                begin=Words("Begin hand task", "Handaufgabe beginnen"),
                guidance=Words(
                    "Make sure that the participant stands on the start square and uses the "
                    "writing hand, then begin.",
                    "Achten Sie darauf, dass die Person auf dem Startquadrat steht und die "
                    "Schreibhand benutzt; dann beginnen Sie.",
                ),
            ),
            Limb.FOOT: PhaseWords(
                title=Words("Foot task", "Fußaufgabe"),
                in_a_sentence=Words("foot task", "Fußaufgabe"),
                begin=Words("Begin foot task", "Fußaufgabe beginnen"),
                guidance=Words(
                    "Make sure that the participant stands on the start square, then begin.",
                    "Achten Sie darauf, dass die Person auf dem Startquadrat steht; dann "
                    "beginnen Sie.",
                ),
            ),
        },
    ),
    StepKindSpec(
        key="road_crossing",
        name=_CROSSING,
        icon="walk",
        command="begin_phase",
        phase_key="road_crossing",
        counts=True,
        needs_body=True,
        has_road=True,
        phases={
            None: PhaseWords(
                title=_CROSSING,
                in_a_sentence=Words("crossing the road", "Überqueren der Straße"),
                begin=Words("Begin the crossing", "Überqueren beginnen"),
                guidance=Words(
                    "Make sure that the participant stands on the start square, that the way "
                    "ahead is free, and that somebody walks beside them; then begin.",
                    "Achten Sie darauf, dass die Person auf dem Startquadrat steht, der Weg nach "
                    "vorn frei ist und jemand neben ihr geht; dann beginnen Sie.",
                ),
            ),
        },
    ),
    StepKindSpec(
        key="questionnaire",
        name=Words("Questionnaire", "Fragebogen"),
        icon="form",
        screen="form",
        command="enter_answers",
        guidance=Words(
            "The participant answers on the tablet, or you read the items aloud and enter the "
            "answers.",
            "Die Person antwortet am Tablet, oder Sie lesen die Fragen vor und geben die "
            "Antworten ein.",
        ),
    ),
    StepKindSpec(
        key="debrief",
        name=Words("Debriefing", "Abschlussgespräch"),
        icon="flag",
        records_movement=False,
        done=Words("Finish session", "Sitzung abschließen"),
        guidance=Words(
            "Help the participant out of the headset and explain what the study was about.",
            "Helfen Sie der Person aus dem Headset und erklären Sie, worum es in der Studie ging.",
        ),
    ),
)

STEP_KINDS: Mapping[str, StepKindSpec] = MappingProxyType({one.key: one for one in _TABLE})
"""Every kind by its key, in the order in which kinds are listed anywhere."""

TIMED_KINDS: tuple[StepKind, ...] = tuple(one.key for one in _TABLE if one.family == "timed")
"""Kinds of steps that are phases: they run on the headset's clock and are recorded as such."""
FORM_KINDS: tuple[StepKind, ...] = tuple(one.key for one in _TABLE if one.family == "form")
COUNTED_KINDS: tuple[StepKind, ...] = tuple(one.key for one in _TABLE if one.counts)
"""Kinds of phases that count as the study's data."""
BOX_KINDS: tuple[StepKind, ...] = tuple(one.key for one in _TABLE if one.has_boxes)
"""Kinds of phases in which a limb reaches for the boxes of a task."""
ROAD_KINDS: tuple[StepKind, ...] = tuple(one.key for one in _TABLE if one.has_road)
"""Kinds of phases in which the participant crosses the study's road."""
UNCOUNTED_KINDS: tuple[StepKind, ...] = tuple(
    one.key for one in _TABLE if one.family == "timed" and not one.counts
)
"""Kinds of phases that are recorded, but in no figure or test."""
PHASES: Mapping[str, PhaseWords] = MappingProxyType(
    {str(one.key_of_phase(limb)): words for one in _TABLE for limb, words in one.phases.items()}
)
"""The texts of every timed phase, by its key in the rules of a study."""


def kinds_with_command(command: StepCommand) -> tuple[StepKind, ...]:
    """Return the kinds that the experimenter carries out with this command."""
    return tuple(one.key for one in _TABLE if one.command == command)


def step_kind_texts() -> dict[str, Words]:
    """Return every text by its key in the pages.

    Keys begin with `step.` for a title, `guide.` for guidance, `do.` for a button.
    """
    texts = dict[str, Words]()
    for kind, spec in STEP_KINDS.items():
        texts[f"step.{kind}"] = spec.name
        if spec.guidance is not None:
            texts[f"guide.{kind}"] = spec.guidance
        if spec.done is not None:
            texts[f"do.complete.{kind}"] = spec.done
        for limb, words in spec.phases.items():
            place = kind if limb is None else f"{kind}.{limb}"
            texts[f"step.{place}"] = words.title
            texts[f"guide.{place}"] = words.guidance
            texts[f"do.begin.{place}"] = words.begin
    return texts | {f"validity.phase.{key}": words.in_a_sentence for key, words in PHASES.items()}


def step_kinds_for_pages() -> dict[str, dict[str, Any]]:
    """Return the properties of every kind that the pages need, as plain values.

    `limbs`: the limbs used at the boxes; empty if the kind needs none. `isCompletedByButton`:
    whether the experimenter ends it with a plain button.
    """
    return {
        kind: {
            "family": spec.family,
            "icon": spec.icon,
            "limbs": [str(limb) for limb in spec.phases if limb is not None],
            "counts": spec.counts,
            "isCompletedByButton": spec.done is not None,
        }
        for kind, spec in STEP_KINDS.items()
    }
