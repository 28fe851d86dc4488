"""Compute all test results of a study from its sessions of one kind.

Alpha and the primary test belong in the study file, before data are collected. If a study does
not declare alpha, the usual 5 % is used, and the results say that it was not declared.
"""

from collections.abc import Iterator, Sequence
from itertools import chain

from app.features.results.analysis.demographics import KEY as DEMOGRAPHICS
from app.features.results.analysis.figures.drawing import limb_note
from app.features.results.analysis.material import Material
from app.features.results.analysis.questions.descriptives import descriptive
from app.features.results.analysis.questions.effects import effects_of
from app.features.results.analysis.questions.limb_tests import limb_results
from app.features.results.analysis.questions.measures import (
    LATENCY_FACTOR,
    Factor,
    Measure,
    body_factor,
    completed,
    left_out,
    measures_of,
)
from app.features.results.analysis.questions.models import carry_over_result, model_results
from app.features.results.analysis.questions.relations import (
    contact_finger_results,
    contact_share_results,
    demographics,
    subjective_objective,
)
from app.features.results.analysis.questions.reliability import reliability
from app.features.results.analysis.questions.words import TestReport
from app.features.results.analysis.schemas import GlanceView, MeasureView, StatisticsResults
from app.features.results.analysis.tables import n_not_valid

USUAL_ALPHA = 0.05
MIN_TESTED = 2
DECLARED = (
    "The study's preregistered test is on the page Preregistration, with its exclusions. "
    "The tests on this page were not preregistered and are exploratory."
)
BODIES = (
    "Conditions of this study share latencies and differ in their bodies: bodies are compared at "
    "each latency that several of them share, and latencies for each body. A preregistered "
    "primary test compares all conditions."
)
OPEN = "Tests use valid completed sessions; open sessions may still change and are left out."
SIMULATED = "These are simulated data: they test the analysis and say nothing about people."
TEST = "These are test sessions; their results mean nothing."
MARKS = {"simulated": "Simulated data, not people", "test": "Test sessions, not people"}
"""What a line that is copied into a paper begins with, if it is not of people."""


def answers_of(material: Material) -> StatisticsResults:
    """Return the test results of a study, without measures of fewer than two participants."""
    sessions = material.sessions
    declared = material.protocol.preregistration
    alpha = USUAL_ALPHA if declared is None else declared.alpha
    return StatisticsResults(
        kind=material.kind,
        simulated=material.kind == "simulated",
        n_sessions=len(sessions),
        n_completed=int((sessions["status"] == "completed").sum()),
        n_not_valid=n_not_valid(sessions),
        alpha=alpha,
        declared=declared is not None,
        notes=_notes(material),
        measures=[_marked(one, material.kind) for one in _measures_by_body(material, alpha)],
    )


def _marked(measure: MeasureView, kind: str) -> MeasureView:
    """Return the measure with its lines for a paper marked if they are not of people."""
    mark = MARKS.get(kind)
    if mark is None:
        return measure
    results = [
        one.model_copy(update={"apa": f"{mark}. {one.apa}"}) if one.apa else one
        for one in measure.results
    ]
    return measure.model_copy(update={"results": results})


def _measures_by_body(material: Material, alpha: float) -> Iterator[MeasureView]:
    """Yield comparisons of bodies at one latency, and of latencies for each body.

    Where latencies tell conditions apart, there is nothing but the comparison of latencies.
    """
    if not material.bodies:
        yield from _measures(material, alpha)
    for latency_ms in material.shared_latencies_ms:
        factor = body_factor(material.bodies)
        place = f"bodies at {latency_ms:g} ms"
        for one in _compared(material.at_latency(latency_ms), alpha, factor):
            named = {
                "key": f"{one.key}_bodies_{latency_ms:g}ms",
                "title": f"{one.title}, {place}",
            }
            yield one.model_copy(update=named)
    for body in material.bodies:
        for one in _measures(material.of_body(body), alpha):
            named = {"key": f"{one.key}_{body}", "title": f"{one.title}, body {body}"}
            yield one.model_copy(update=named)


def _notes(material: Material) -> list[str]:
    own = {"simulated": SIMULATED, "test": TEST}.get(material.kind, "")
    declared = "" if material.protocol.preregistration is None else DECLARED
    done = completed(material)
    bodies = BODIES if material.bodies else ""
    notes = (declared, own, OPEN, bodies, limb_note(done.counting(done.phases)))
    return [one for one in notes if one]


def _measures(material: Material, alpha: float) -> Iterator[MeasureView]:
    found = _tested(material, LATENCY_FACTOR)
    yield from _compared(material, alpha, LATENCY_FACTOR, found)
    yield from _explored(material, found, left_out(material))


def _tested(material: Material, factor: Factor) -> list[Measure]:
    return [
        one
        for one in measures_of(material, factor)
        if one.values["participant_code"].nunique() >= MIN_TESTED
    ]


def _compared(
    material: Material, alpha: float, factor: Factor, found: Sequence[Measure] | None = None
) -> Iterator[MeasureView]:
    """Yield the results of every measure at two levels of the factor or more."""
    out = left_out(material)
    for measure in _tested(material, factor) if found is None else found:
        if len(measure.levels) < MIN_TESTED:
            continue
        n = int(measure.values["participant_code"].nunique())
        results = list(_results(measure, alpha))
        yield MeasureView(
            key=measure.key,
            title=measure.title,
            unit=measure.unit,
            about=measure.about,
            n=n,
            left_out=[*out, *measure.missing()],
            glance=_glance(measure, results),
            effects=list(effects_of(measure)),
            results=[one.view() for one in results],
        )


def _results(measure: Measure, alpha: float) -> Iterator[TestReport]:
    yield descriptive(measure)
    for limb in measure.limbs:
        yield from limb_results(measure, limb, alpha)
    if measure.continuous:
        yield from model_results(measure, alpha)
    yield from carry_over_result(measure)


def _glance(measure: Measure, results: Sequence[TestReport]) -> list[GlanceView]:
    brief = {one.key: one.brief for one in results if one.brief is not None}
    text = {key: one.text for key, one in brief.items()}
    return [
        GlanceView(
            limb=limb,
            factor="latency" if measure.factor.order is None else "body",
            differ=text.get(f"friedman_{limb}"),
            first=text.get(f"planned_{limb}", text.get(f"pairs_{limb}")),
            trend=text.get(f"trend_{limb}"),
            way=brief[f"trend_{limb}"].way if f"trend_{limb}" in brief else None,
        )
        for limb in measure.limbs
    ]


def _explored(
    material: Material, found: Sequence[Measure], out: list[str]
) -> Iterator[MeasureView]:
    if not found:
        return
    sections = (
        (
            "contact_shares",
            "Contact by body part",
            chain(contact_share_results(material), contact_finger_results(material)),
        ),
        ("reliability", "Consistency of the questionnaires", reliability(material)),
        ("relations", "Subjective and objective measures", subjective_objective(found)),
        (DEMOGRAPHICS, "Scores by demographics", demographics(material, found)),
    )
    n = max(int(one.values["participant_code"].nunique()) for one in found)
    for key, title, results in sections:
        views = [one.view() for one in results]
        if views:
            yield MeasureView(
                key=key,
                title=title,
                unit="",
                about="",
                n=n,
                left_out=out,
                glance=[],
                effects=[],
                results=views,
            )
