"""Tests of the study's questions, answered from sessions with known answers."""

import pytest
from sqlalchemy import select, update

from app.database import Database
from app.features.design.studies import add_version, study_by_key
from app.features.movement.avatar import add_shipped_avatar
from app.features.movement.humanoids import add_shipped_bodies
from app.features.results.analysis.dashboard import build_dashboard, drawings_of
from app.features.results.analysis.material import OWN_BODY, read_material
from app.features.results.analysis.questions.answers import BODIES, DECLARED, answers_of
from app.features.results.analysis.questions.relations import group_of
from app.features.results.analysis.questions.words import bounded, p_words
from app.features.results.analysis.schemas import MeasureView, ResultView, StatisticsResults
from app.models import Contact, JointErrorRow, Participant, Phase, StudySession
from app.protocol import ROAD_KINDS
from app.protocol.plan import Step
from tests.features.builders import NOW, STUDY, SessionSpec, build_session
from tests.protocol.helpers import STUDY as FILE
from tests.protocol.helpers import edited
from tests.protocol.test_condition_bodies import with_bodies
from tests.protocol.test_preregistration import SECTION

PHYSICS = "physics\navatar_configuration: {key: standard, version: 2}"
FALLING = {0.0: 7, 125.0: 5, 350.0: 2}
"""What every participant answers to every item, by latency."""


def _likert(step: Step, item: str) -> int:
    # Agency is q6 + q7 + q8 - q9: q9 is reversed so that it falls with the others.
    value = FALLING[step.latency_ms or 0.0]
    return 8 - value if item == "q9" else value


def _found(database: Database, people: int, **changes: str) -> StatisticsResults:
    with database.writing() as db:
        for at in range(people):
            build_session(db, SessionSpec(f"P-{at:04d}", likert=_likert))
        if changes:
            build_session(db, SessionSpec("P-9999", likert=_likert, **changes))  # type: ignore[arg-type]  # a status
    with database.reading() as db:
        return answers_of(read_material(db, STUDY, "people"))


def _measure(found: StatisticsResults, key: str) -> MeasureView:
    return next(one for one in found.measures if one.key == key)


def _result(found: StatisticsResults, measure: str, key: str) -> ResultView:
    return next(one for one in _measure(found, measure).results if one.key == key)


@pytest.mark.one_engine
def test_identical_participants_give_the_smallest_possible_p(database: Database) -> None:
    """Six identical participants give Friedman's smallest exact p, 6^-5, and W = 1."""
    found = _found(database, 6, status="withdrawn")
    friedman = _result(found, "karas2020_agency", "friedman_hand")
    assert "χ²(2, N = 6) = 12.00, p < .001 (exact), Kendall’s W = 1.00" in friedman.apa
    planned = _result(found, "karas2020_agency", "planned_hand")
    # Two-sided exact p of six pairs one way: 2 / 2^6 = .03125, adjusted for two it is .0625.
    assert [row[5:7] for row in planned.rows] == [[".031", ".062"], [".031", ".062"]]
    assert "No latency differs from 0 ms" in planned.sentence
    assert any("Too few participants for any result" in one for one in planned.warnings)
    predicted = _result(found, "karas2020_agency", "trend_hand")
    # One-sided: 1 / 2^6 = .0156, adjusted .031; Page's: 6^-6.
    assert "The prediction is supported: one-sided p < .001" in predicted.sentence
    assert [row[4] for row in predicted.rows] == [".031", ".031"]
    agency = _measure(found, "karas2020_agency")
    assert (agency.n, agency.left_out) == (6, ["P-9999: withdrawn"])
    assert [tuple(one.model_dump().values()) for one in agency.glance] == [
        ("hand", "latency", "p < .001, W = 1.00", None, "p < .001", "falls"),
        ("foot", "latency", "p < .001, W = 1.00", None, "p < .001", "falls"),
    ]


@pytest.mark.one_engine
def test_the_time_of_the_thumb_at_each_side_is_stated(database: Database) -> None:
    """Contacts by finger give a row for the thumb at every latency; without any there is none."""
    without = _found(database, 3)
    assert not any(one.key == "contact_fingers_hand" for one in _shares(without))
    with database.writing() as db:
        own = (Contact.surface_kind == "side", Contact.surface.like("hand/%"))
        db.execute(update(Contact).where(*own).values(body_part="RightThumbDistal"))
    with database.reading() as db:
        found = answers_of(read_material(db, STUDY, "people"))
    (stated,) = (one for one in _shares(found) if one.key == "contact_fingers_hand")
    thumb = {row[0]: row for row in stated.rows if row[1] == "thumb"}
    assert list(thumb) == ["0", "125", "350"]
    assert stated.columns[:2] == ["latency (ms)", "finger"]
    for row in thumb.values():
        assert float(row[-2]) == pytest.approx(sum(map(float, row[2:-2])), abs=0.02)
        assert (float(row[-2]) > 0.0, row[-1]) == (True, "3")


@pytest.mark.one_engine
def test_sessions_without_fingers_enter_no_mean_by_finger(database: Database) -> None:
    """Of three equal sessions one sent fingers: means by finger stay the same, with n = 1."""
    _found(database, 3)
    own = (Contact.surface_kind == "side", Contact.surface.like("hand/%"))
    stated = []
    for without in ((), ("P-0001", "P-0002")):
        people = select(StudySession.id).join(Participant).where(Participant.code.in_(without))
        with database.writing() as db:
            db.execute(update(Contact).where(*own).values(body_part="RightThumbDistal"))
            others = Contact.session_id.in_(people)
            db.execute(update(Contact).where(*own, others).values(body_part="RightHand"))
        with database.reading() as db:
            found = _shares(answers_of(read_material(db, STUDY, "people")))
        fingers, shares = (
            next(one for one in found if one.key == f"contact_{key}_hand")
            for key in ("fingers", "shares")
        )
        stated.append([row[:-1] for row in fingers.rows if row[1] == "thumb"])
        counted, groups = {row[-1] for row in fingers.rows}, {row[1] for row in shares.rows}
    assert stated[0] == stated[1]
    assert (counted, "finger" in groups, "hand" in groups) == ({"1"}, False, True)


@pytest.mark.one_engine
def test_fingers_are_booked_as_fingers_where_only_some_sessions_have_them(
    database: Database,
) -> None:
    """Shares of contact are stated apart for phases with and without fingers, never merged."""
    _found(database, 2)
    own = (Contact.surface_kind == "side", Contact.surface.like("hand/%"))
    first = Contact.session_id.in_(
        select(StudySession.id).join(Participant).where(Participant.code == "P-0000")
    )
    with database.writing() as db:
        db.execute(update(Contact).where(*own).values(body_part="RightHand"))
        db.execute(update(Contact).where(*own, first).values(body_part="RightIndexDistal"))
    with database.reading() as db:
        found = {one.key: one for one in _shares(answers_of(read_material(db, STUDY, "people")))}
    with_fingers = found["contact_shares_fingers_hand"]
    assert {(row[1], row[2], row[3]) for row in with_fingers.rows} == {("finger", "100.0 %", "1")}
    assert "with fingers" in with_fingers.title
    without = found["contact_shares_hand"]
    assert {(row[1], row[2], row[3]) for row in without.rows} == {("hand", "100.0 %", "1")}
    assert "there the hand includes them" in without.method


@pytest.mark.one_engine
def test_the_joint_error_of_the_fingers_is_a_measure_of_its_own(database: Database) -> None:
    """Fingers have their own joint error, and that of the body is the same with and without."""
    with database.writing() as db:
        for at in range(3):
            build_session(db, SessionSpec(f"P-{at:04d}", joint_error_rad=lambda *_: 0.1))
    with database.reading() as db:
        before = answers_of(read_material(db, STUDY, "people"))
    assert "joint_error_fingers" not in {one.key for one in before.measures}
    with database.writing() as db:
        for row in list(db.scalars(select(JointErrorRow).filter_by(joint="RightHand"))):
            names = [column.key for column in JointErrorRow.__table__.columns]
            own = {name: getattr(row, name) for name in names}
            own |= {"joint": "RightThumbDistal", "mean_rad": 0.3}
            db.add(JointErrorRow(**own))
    with database.reading() as db:
        after = answers_of(read_material(db, STUDY, "people"))
    fingers = _result(after, "joint_error_fingers", "means")
    body = [_result(one, "joint_error", "means") for one in (before, after)]
    assert body[0] == body[1]
    assert "17.19" in str(fingers.rows)


@pytest.mark.one_engine
def test_bodies_are_those_of_the_versions_that_ran(database: Database) -> None:
    """Sessions of an older version whose conditions share a latency are analysed by body."""
    text = with_bodies("female", "male", physics=False)
    text = text.replace("avatar: delayed_copy", f"avatar: {PHYSICS}", 1)
    with database.writing() as db:
        add_shipped_bodies(db, NOW)
        add_shipped_avatar(db, NOW)
        add_version(db, study_by_key(db, STUDY), text, NOW)
        build_session(db, SessionSpec("P-0000"))
        build_session(db, SessionSpec("P-0001"))
        newer = edited(("Acting through another body", "Acting through another one"))
        add_version(db, study_by_key(db, STUDY), newer, NOW)
    with database.reading() as db:
        material = read_material(db, STUDY, "people")
        found = answers_of(material)
        ms = {body: material.of_body(body).phases for body in material.bodies}
    assert material.protocol.has_latencies_apart
    assert material.bodies == ("female", "male", OWN_BODY)
    tasks = {body: rows[rows["phase_kind"] == "task"] for body, rows in ms.items()}
    assert {body: set(rows["condition"]) for body, rows in tasks.items()} == {
        "female": {"latency_0"},
        "male": {"latency_125"},
        OWN_BODY: {"latency_350"},
    }
    assert BODIES in found.notes


BY_BODY = {"female": 6, "male": 4, None: 1}
"""What every participant answers to every item, by the body that they wear."""


def _likert_of_body(step: Step, item: str) -> int:
    value = BY_BODY[step.body] if step.block else 4
    return 8 - value if item == "q9" else value


@pytest.mark.one_engine
def test_bodies_at_one_latency_are_compared(database: Database) -> None:
    """A study that varies the body at one latency is tested and drawn by body, in pairs."""
    text = with_bodies("female", "male", physics=False).replace("latency_ms: 125", "latency_ms: 0")
    text = text.replace("latency_ms: 350", "latency_ms: 0")
    text = text.replace("avatar: delayed_copy", f"avatar: {PHYSICS}", 1)
    with database.writing() as db:
        add_shipped_bodies(db, NOW)
        add_shipped_avatar(db, NOW)
        add_version(db, study_by_key(db, STUDY), text, NOW)
        for at in range(8):
            build_session(db, SessionSpec(f"P-{at:04d}", likert=_likert_of_body))
    with database.reading() as db:
        material = read_material(db, STUDY, "people")
        found = answers_of(material)
        drawings = {one.key: one for one in drawings_of(material)}
    assert material.shared_latencies_ms == (0.0,)
    key = "karas2020_agency_bodies_0ms"
    agency = _measure(found, key)
    assert (agency.title, agency.n) == ("Agency, bodies at 0 ms", 8)
    friedman = _result(found, key, "friedman_hand")
    assert friedman.title == "Hand: Do the bodies differ?"
    assert "χ²(2, N = 8) = 16.00" in friedman.apa
    pairs = _result(found, key, "pairs_hand")
    # Two-sided exact p of eight pairs one way: 2 / 2^8 = .0078, adjusted for three it is .023.
    names = ["female − male", f"female − {OWN_BODY}", f"male − {OWN_BODY}"]
    assert [(row[0], row[5], row[6]) for row in pairs.rows] == [
        (name, ".008", ".023") for name in names
    ]
    assert "ms" not in pairs.apa.split()
    keys = {one.key for one in agency.results}
    assert not keys & {"trend_hand", "planned_hand"}
    (hand, _) = agency.glance
    assert (hand.factor, hand.trend) == ("body", None)
    assert hand.first == f"female and male; female and {OWN_BODY}; male and {OWN_BODY}"
    drawn = drawings["embodiment_agency_bodies_0ms"]
    means = drawn.data[drawn.data["row"] == "mean"]
    hands = means[means["limb"] == "hand"]
    assert hands["body"].tolist() == ["female", "male", OWN_BODY]
    assert hands["value"].is_monotonic_decreasing
    assert drawings["completions_bodies_0ms"].n == 8
    assert "Only the body" not in drawn.caption
    assert "Only the body female" in drawings["embodiment_agency"].caption


def _shares(found: StatisticsResults) -> list[ResultView]:
    shares = [one for one in found.measures if one.key == "contact_shares"]
    return [result for one in shares for result in one.results]


@pytest.mark.one_engine
def test_the_overview_shows_the_observed_direction(database: Database) -> None:
    """The overview shows a measure's observed direction, even if the opposite was predicted."""
    rising = {0.0: 2, 125.0: 5, 350.0: 7}
    with database.writing() as db:
        for at in range(6):
            spec = SessionSpec(
                f"P-{at:04d}",
                likert=lambda step, item: (
                    8 - rising[step.latency_ms or 0.0]
                    if item == "q9"
                    else rising[step.latency_ms or 0.0]
                ),
            )
            build_session(db, spec)
    with database.reading() as db:
        found = answers_of(read_material(db, STUDY, "people"))
    line = _measure(found, "karas2020_agency").glance[0]
    assert (line.trend, line.way) == ("p = 1.000", "rises")
    reported = _result(found, "karas2020_agency", "trend_hand")
    assert "The prediction is not supported" in reported.sentence


@pytest.mark.one_engine
def test_a_constant_measure_has_no_direction(database: Database) -> None:
    """A measure that does not change has no direction, and no p either."""
    found = _found(database, 4)
    reported = _result(found, "completions", "trend_hand")
    assert reported.sentence.startswith("This cannot be tested. Each of 4 subjects has the same")
    line = _measure(found, "completions").glance[0]
    assert (line.differ, line.first, line.trend, line.way) == (None, None, None, None)


@pytest.mark.one_engine
def test_results_state_alpha_and_never_say_significant(database: Database) -> None:
    """Results state alpha, avoid the word "significant", and say if tests were not declared."""
    found = _found(database, 3)
    text = found.model_dump_json()
    assert "significant" not in text
    assert "α = .05" in text
    assert found.declared is False


@pytest.mark.one_engine
def test_alpha_is_the_declared_one(database: Database) -> None:
    """A declared alpha is used, and all other tests are called exploratory."""
    declared = SECTION.replace("alpha: 0.05", "alpha: 0.01")
    with database.writing() as db:
        add_version(db, study_by_key(db, STUDY), FILE + declared, NOW)
    found = _found(database, 3)
    assert (found.alpha, found.declared) == (0.01, True)
    assert found.notes[0] == DECLARED
    assert "α = .05" not in found.model_dump_json()


@pytest.mark.one_engine
def test_one_participant_gives_no_measures(database: Database) -> None:
    """With one participant the answers have no measures and raise no error."""
    assert _found(database, 1).measures == []


@pytest.mark.one_engine
def test_a_rescaled_score_is_not_tested_twice(database: Database) -> None:
    """`soe_rescaled`, which is 1.5 times `soe_thesis`, is not tested separately."""
    keys = [one.key for one in _found(database, 3).measures]
    assert "karas2020_soe_thesis" in keys
    assert "karas2020_soe_rescaled" not in keys


@pytest.mark.parametrize(
    ("part", "group"),
    [
        ("RightIndexDistal", "finger"),
        ("LeftThumbProximal", "finger"),
        ("RightHand", "hand"),
        ("LeftLowerArm", "arm"),
        ("LeftFoot", "foot"),
        ("RightUpperLeg", "leg"),
        ("UpperChest", "trunk and head"),
    ],
)
def test_body_parts_are_grouped_by_kind(part: str, group: str) -> None:
    """A body part belongs to the group of its kind, such as finger, hand or arm."""
    assert group_of(part) == group


def test_numbers_are_printed_in_apa_style() -> None:
    """Numbers are printed in APA style: no leading zero below 1, and a bound for a small p."""
    assert (p_words(0.0004), p_words(0.0125), p_words(1.0)) == ("p < .001", "p = .013", "p = 1.000")
    assert (bounded(-0.5, 2), bounded(1.0, 2), bounded(0.0, 2)) == ("−.50", "1.00", ".00")


@pytest.mark.one_engine
def test_figures_and_tests_of_boxes_leave_the_road_out(database: Database) -> None:
    """With crossings instead of foot tasks every figure is drawn, and tests are of the hand."""
    with database.writing() as db:
        for code in ("P-0001", "P-0002", "P-0003"):
            build_session(db, SessionSpec(code))
        feet = update(Phase).where(Phase.limb == "foot")
        db.execute(feet.values(kind=ROAD_KINDS[0], limb=None))
    with database.reading() as db:
        figures = {one.key: one.figure for one in build_dashboard(db, STUDY, "people").figures}
        found = {one.key: one for one in answers_of(read_material(db, STUDY, "people")).measures}
    assert None not in (figures["completions"], figures["contacts"], figures["joint_error_body"])
    for measure in ("completions", "contact_time", "joint_error"):
        assert {one.limb for one in found[measure].glance} == {"hand"}
