"""Texts of a pilot for the ethics form and the preregistration, each in both languages."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from decimal import ROUND_HALF_UP, Decimal
from typing import Any, Final

from app.features.results.pilot.example import EXAMPLE_SOURCE
from app.features.results.pilot.schemas import WithoutTask
from app.features.results.pilot.simulation.check import Reached
from app.features.results.pilot.simulation.power import Curve
from app.protocol import PRIMARY_DIRECTIONS, PRIMARY_MEASURES, PrimaryNames
from app.science.pilot import PowerPoint
from app.science.statistical_tests import statistical_test
from app.simulated_people.visits import AvatarKind
from app.texts import LANGUAGES, Words, chosen

Texts = dict[str, str]
"""One text by language."""

_AVATARS: Final[Mapping[AvatarKind, Words]] = {
    "physics": Words(en="physics with contacts", de="Physik mit Kontakten"),
    "physics_without_fingers": Words(
        en="physics with contacts, hands without fingers",
        de="Physik mit Kontakten, Hände ohne Finger",
    ),
    "delayed_copy": Words(
        en="a delayed copy of the body, which passes through edges",
        de="verzögerte Kopie des Körpers, die durch Kanten hindurchgeht",
    ),
}
_LIMBS: Final = {
    "hand": Words(en="hand task", de="Handaufgabe"),
    "foot": Words(en="foot task", de="Fußaufgabe"),
    "both": Words(en="mean of both tasks", de="Mittel beider Aufgaben"),
}
_SCORE: Final = Words(
    en="score “{{score}}” of {{instrument}}", de="Wert „{{score}}“ aus {{instrument}}"
)
_NOT_SIMULATED: Final = Words(
    en="The number of participants was not derived from a simulation: nothing is assumed yet of "
    "how people would answer.",
    de="Die Zahl der Teilnehmenden wurde nicht aus einer Simulation abgeleitet: Wie Menschen "
    "antworten würden, ist noch nicht angenommen.",
)
_SIMULATED: Final = Words(
    en="The power of the test ({{test}}; alpha {{alpha}}) was simulated with {{sets}} data sets "
    "for each number of participants, in the study's own orders and with its own exclusions, seed "
    "{{seed}}: {{points}}. Bands are Clopper-Pearson intervals of 95 %. All of it follows from "
    "assumptions that nobody has measured in this study (SHA-256 {{sha256}}).",
    de="Die Teststärke des Tests ({{test}}; α = {{alpha}}) wurde mit {{sets}} Datensätzen für jede "
    "Zahl von Teilnehmenden simuliert, in den Reihenfolgen der Studie und mit ihren Ausschlüssen, "
    "Startwert {{seed}}: {{points}}. Die Bänder sind Clopper-Pearson-Intervalle von 95 %. All das "
    "folgt aus Annahmen, die in dieser Studie niemand gemessen hat (SHA-256 {{sha256}}).",
)
_DECLARED: Final = Words(
    en=" The test is the one that the study preregisters.",
    de=" Der Test ist der, den die Studie präregistriert.",
)
_OF_ASSUMPTIONS: Final = Words(
    en=" The study preregisters no test: this one stands in the assumptions.",
    de=" Die Studie präregistriert keinen Test: Dieser steht in den Annahmen.",
)
_OF_EXAMPLE: Final = Words(
    en=" The study preregisters no test: this one stands in the assumptions, which began as the "
    "inserted example.",
    de=" Die Studie präregistriert keinen Test: Dieser steht in den Annahmen, die als eingefügtes "
    "Beispiel begannen.",
)
_EXAMPLE_KEPT: Final = Words(
    en=" {{kept}} of the {{all}} assumed numbers are still those of the example.",
    de=" {{kept}} der {{all}} angenommenen Zahlen sind noch die des Beispiels.",
)
_EFFECT: Final = Words(
    en=" Assumed effect: from the shortest to the longest latency, the mean of {{measure}} changes "
    "by {{difference}}{{range}} in people whom nothing else disturbs.",
    de=" Angenommene Wirkung: Von der kürzesten zur längsten Latenz ändert sich das Mittel "
    "({{measure}}) um {{difference}}{{range}}, bei Menschen, die sonst nichts stört.",
)
_POSSIBLE: Final = Words(
    en=" (possible are {{low}} to {{high}})", de=" (möglich sind {{low}} bis {{high}})"
)
_TEST: Final = Words(
    en="{{test}}: {{measure}}, {{limb}}, by added latency; {{direction}}",
    de="{{test}}: {{measure}}, {{limb}}, nach zusätzlicher Latenz; {{direction}}",
)
_POINT: Final = Words(
    en="n = {{n}}: {{power}} [{{low}}, {{high}}], level {{level}}",
    de="n = {{n}}: {{power}} [{{low}}; {{high}}], Niveau {{level}}",
)
_NEVER_TESTED: Final = Words(
    en="n = {{n}}: no data set could be analysed",
    de="n = {{n}}: kein Datensatz ließ sich auswerten",
)
_REACH_UNKNOWN: Final = Words(
    en="Reach was not looked at.", de="Die Reichweite wurde nicht geprüft."
)
_REACHED: Final = Words(
    en="Every box was reached by simulated bodies {{bodies}} in a check in which edges of boxes "
    "stop nobody.",
    de="Simulierte Körper {{bodies}} haben jeden Kasten erreicht, in einer Prüfung, in der die "
    "Kanten der Kästen niemanden aufhalten.",
)
_OUT_OF_REACH: Final = Words(
    en="Out of reach of simulated bodies {{bodies}}: {{which}}.",
    de="Außer Reichweite simulierter Körper {{bodies}}: {{which}}.",
)
_BODIES: Final = Words(
    en="from {{shortest}} to {{tallest}} m (5th percentile of women to 95th of men)",
    de="von {{shortest}} bis {{tallest}} m (5. Perzentil der Frauen bis 95. der Männer)",
)
_VISIT: Final = Words(
    en="A visit to the study “{{title}}” takes about {{minutes}} minutes",
    de="Ein Termin der Studie „{{title}}“ dauert etwa {{minutes}} Minuten",
)
_WALKS_BACK: Final = Words(
    en=", of which {{minutes}} minutes are simulated walks back between tasks",
    de=", davon {{minutes}} Minuten simulierte Rückwege zwischen den Aufgaben",
)
_REST_OF_VISIT: Final = Words(
    en="; {{planned}} minutes are set by the protocol, and the rest is an estimate of forms, texts "
    "and steps by hand. Breaks and putting on the equipment are not included",
    de="; {{planned}} Minuten gibt das Studienprotokoll vor, der Rest ist für Fragebögen, Texte "
    "und Schritte von Hand geschätzt. Pausen und das Anlegen der Ausrüstung sind nicht enthalten",
)
_REHEARSED: Final = Words(
    en="Before anybody takes part, the procedure was rehearsed with {{people}} simulated people "
    "(seed {{seed}})",
    de="Bevor jemand teilnimmt, wurde der Ablauf mit {{people}} simulierten Menschen (Startwert "
    "{{seed}}) geprobt",
)
_ALL_COMPLETED: Final = Words(
    en="; all of these visits came to their end.", de="; alle diese Termine kamen zu Ende."
)
_WITH_TASKS: Final = Words(
    en=" Everybody completed at least one task in every phase.",
    de=" Alle haben in jeder Phase mindestens eine Aufgabe geschafft.",
)
_WITHOUT_TASK: Final = Words(
    en=" Some of them completed no task in a phase: {{which}}. Simulated people do not get used to "
    "a latency.",
    de=" Manche haben in einer Phase keine Aufgabe geschafft: {{which}}. Simulierte Menschen "
    "gewöhnen sich nicht an eine Latenz.",
)
_WITHOUT_TASK_HERE: Final = Words(
    en="{{without}} of {{people}} ({{limb}}, {{latency}} ms)",
    de="{{without}} von {{people}} ({{limb}}, {{latency}} ms)",
)
_SOME_FAILED: Final = Words(
    en="; {{failures}} of these visits could not be completed.",
    de=". Termine, die nicht zu Ende kamen: {{failures}}.",
)
_ANOTHER_AVATAR: Final = Words(
    en=" They acted through another avatar ({{used}}) than the study's own ({{own}}).",
    de=" Sie handelten mit einem anderen Avatar ({{used}}) als dem der Studie ({{own}}).",
)
_AS_RECORDED: Final = Words(
    en=" Their hands moved as recorded ones did (reaches: {{reaches}}, people: {{people}}{{made}}; "
    "SHA-256 {{sha256}}).",
    de=" Ihre Hände bewegten sich wie aufgezeichnete (Armbewegungen: {{reaches}}, Menschen: "
    "{{people}}{{made}}; SHA-256 {{sha256}}).",
)
_SYNTHETIC: Final = Words(en="; synthetic", de="; künstlich")
_STORAGE: Final = Words(
    en="The movement recorded of one person takes about {{size}} MB. These figures come from a "
    "simulation and say nothing about how people will feel.",
    de="Die aufgezeichnete Bewegung einer Person belegt etwa {{size}} MB. Diese Zahlen stammen aus "
    "einer Simulation und sagen nichts darüber, wie Menschen sich fühlen werden.",
)


@dataclass(frozen=True)
class Rehearsed:
    """What the text for the ethics form says of a cohort.

    `title`: that of the study, by language. `used` and `own`: the avatar of the simulation and that
    of the study. `without_task`: where people completed no task, None if nobody did any phase.
    `session_min` includes `planned_min` and `walk_back_min`. `reaching`: what the record says
    of recorded hands, None without them.
    """

    title: Mapping[str, str]
    people: int
    seed: int
    failures: int
    used: AvatarKind
    own: AvatarKind
    session_min: float
    planned_min: float
    walk_back_min: float
    storage_mb: float
    reached: Sequence[Reached]
    without_task: Sequence[WithoutTask] | None = None
    reaching: Mapping[str, Any] | None = None


def ethics_texts(rehearsed: Rehearsed) -> Texts:
    """Return a text for the ethics form, with the figures of a cohort."""
    return {language: _ethics(rehearsed, language) for language in LANGUAGES}


def preregistration_texts(curve: Curve | None) -> Texts:
    """Return a text for the preregistration: how the number of participants was simulated."""
    return {language: _preregistration(curve, language) for language in LANGUAGES}


def reach_sentence(reached: Sequence[Reached], language: str = "en") -> str:
    """Say which boxes simulated bodies reached."""
    missed = [one for one in reached if one.out_of_reach]
    statures_m = sorted({one.stature_m for one in reached})
    if not statures_m:
        return _REACH_UNKNOWN.in_language(language)
    bodies = _filled(
        _BODIES,
        language,
        shortest=_number(statures_m[0], 3, language),
        tallest=_number(statures_m[-1], 3, language),
    )
    if not missed:
        return _filled(_REACHED, language, bodies=bodies)
    which = ", ".join(sorted({surface for one in missed for surface in one.out_of_reach}))
    return _filled(_OUT_OF_REACH, language, bodies=bodies, which=which)


def _ethics(one: Rehearsed, language: str) -> str:
    title, minutes = chosen(one.title, language), _number(one.session_min, 0, language)
    visit = _filled(_VISIT, language, title=title, minutes=minutes)
    back = _number(one.walk_back_min, 1, language)
    if back != _number(0.0, 1, language):
        visit += _filled(_WALKS_BACK, language, minutes=back)
    planned = _number(one.planned_min, 0, language)
    visit += _filled(_REST_OF_VISIT, language, planned=planned)
    people = _filled(_REHEARSED, language, people=one.people, seed=one.seed)
    people += (
        _filled(_SOME_FAILED, language, failures=one.failures)
        if one.failures
        else _ALL_COMPLETED.in_language(language)
    )
    people += _tasks_sentence(one.without_task, language)
    if one.used != one.own:
        used, own = (_AVATARS[kind].in_language(language) for kind in (one.used, one.own))
        people += _filled(_ANOTHER_AVATAR, language, used=used, own=own)
    if one.reaching is not None:
        recorded = {key: one.reaching[key] for key in ("reaches", "people", "sha256")}
        made = _SYNTHETIC.in_language(language) if one.reaching["synthetic"] else ""
        people += _filled(_AS_RECORDED, language, made=made, **recorded)
    storage = _filled(_STORAGE, language, size=_number(one.storage_mb, 0, language))
    return f"{visit}. {people} {reach_sentence(one.reached, language)} {storage}"


def _tasks_sentence(found: Sequence[WithoutTask] | None, language: str) -> str:
    """Say whether everybody completed a task in every phase, which a visit's end does not."""
    if found is None:
        return ""
    if not found:
        return _WITH_TASKS.in_language(language)
    return _filled(_WITHOUT_TASK, language, which=without_task_words(found, language))


def without_task_words(found: Sequence[WithoutTask], language: str = "en") -> str:
    """List how many people completed no task, by limb and latency."""
    return ", ".join(
        _filled(
            _WITHOUT_TASK_HERE,
            language,
            without=one.without,
            people=one.people,
            limb=_LIMBS[one.limb].in_language(language),
            latency=_decimal(f"{one.latency_ms:g}", language),
        )
        for one in found
    )


def _preregistration(curve: Curve | None, language: str) -> str:
    if curve is None or not curve.points:
        return _NOT_SIMULATED.in_language(language)
    header = curve.header
    return _filled(
        _SIMULATED,
        language,
        test=_test_words(header["test"], curve.names, language),
        alpha=_decimal(f"{header['alpha']:g}", language),
        sets=header["sets"],
        seed=header["seed"],
        points="; ".join(_point(one, language) for one in curve.points),
        sha256=header["assumptions_sha256"],
    ) + _basis(curve, language)


def _basis(curve: Curve, language: str) -> str:
    """Say where the test comes from, and which effect is assumed."""
    header, sources = curve.header, [one["source"] for one in curve.header["assumptions"]]
    kept = sources.count(EXAMPLE_SOURCE)
    assumed = _OF_EXAMPLE if kept else _OF_ASSUMPTIONS
    said = (_DECLARED if header["preregistered"] else assumed).in_language(language)
    if kept:
        said += _filled(_EXAMPLE_KEPT, language, kept=kept, all=len(sources))
    possible = ""
    if curve.score_range is not None:
        low, high = (_decimal(f"{end:g}", language) for end in curve.score_range)
        possible = _filled(_POSSIBLE, language, low=low, high=high)
    difference = _number(header["assumed_difference"], 2, language)
    measure = _measure_words(header["test"], curve.names, language)
    return said + _filled(_EFFECT, language, measure=measure, difference=difference, range=possible)


def _test_words(test: Mapping[str, Any], names: PrimaryNames, language: str) -> str:
    """Return a test as the preregistration page names it."""
    return _filled(
        _TEST,
        language,
        test=statistical_test(test["test"]).name.in_language(language),
        measure=_measure_words(test, names, language),
        limb=_LIMBS[test["limb"]].in_language(language),
        direction=PRIMARY_DIRECTIONS[test["direction"]].in_language(language),
    )


def _measure_words(test: Mapping[str, Any], names: PrimaryNames, language: str) -> str:
    return (
        _filled(
            _SCORE,
            language,
            score=_named(names.score, test["score"], language),
            instrument=_named(names.instrument, test["instrument"], language),
        )
        if test["measure"] == "score"
        else PRIMARY_MEASURES[test["measure"]].in_language(language)
    )


def _point(one: PowerPoint, language: str) -> str:
    if one.never_tested:
        return _filled(_NEVER_TESTED, language, n=one.n)
    return _filled(
        _POINT,
        language,
        n=one.n,
        power=_number(one.power, 2, language),
        low=_number(one.low, 2, language),
        high=_number(one.high, 2, language),
        level=_number(one.level, 3, language),
    )


def _named(name: Mapping[str, str] | None, key: str, language: str) -> str:
    return key if name is None else chosen(name, language) or key


def _filled(words: Words, language: str, **values: object) -> str:
    text = words.in_language(language)
    for name, value in values.items():
        text = text.replace(f"{{{{{name}}}}}", str(value))
    return text


def rounded(value: float, decimals: int) -> str:
    """Return a number with so many decimals, halves away from zero, as the pages round."""
    text = f"{Decimal(value).quantize(Decimal(1).scaleb(-decimals), ROUND_HALF_UP):f}"
    # What rounds to zero has no sign.
    return text if text.strip("-0.") else text.removeprefix("-")


def _number(value: float, decimals: int, language: str) -> str:
    return _decimal(rounded(value, decimals), language)


def _decimal(number: str, language: str) -> str:
    return number.replace(".", ",") if language == "de" else number
