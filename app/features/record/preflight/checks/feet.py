"""Check that the headset measures the feet, if the study has a task for them.

Some headsets compute legs from the upper body. They look right and are not measured, so contacts of
such feet are no data.
"""

from app.features.record.headset import newest_goals, state_of_feet
from app.features.record.preflight.check import Finding, Found, Situation, StateCheck
from app.features.record.sessions import plan_of
from app.texts import Words

_REMEDY = Words(
    en="Put trackers on the shins, or use a headset with leg trackers, and calibrate again. "
    "Otherwise skip the foot tasks.",
    de="Befestigen Sie Tracker an den Unterschenkeln oder nehmen Sie ein Headset mit Beintrackern "
    "und kalibrieren Sie neu. Überspringen Sie sonst die Aufgaben mit dem Fuß.",
)


def _feet(situation: Situation) -> Found:
    if all(step.limb != "foot" for step in plan_of(situation.db, situation.session)):
        return Found("unneeded")
    says = situation.context.hub.headset_can(situation.session.id, "goals")
    if says is None:
        return Found("no_headset")
    if not says:
        return Found("unknown")
    goals = newest_goals(situation.db, situation.session.id)
    if goals is None:
        return Found("waiting")
    state = state_of_feet(goals)
    return Found("ok" if state == "tracked" else state, details=(goals.source,))


FEET = StateCheck(
    key="feet",
    title=Words(en="Feet", de="Füße"),
    findings=(
        Finding("unneeded", "unneeded", Words(en="No foot task", de="Keine Aufgabe mit dem Fuß")),
        Finding("no_headset", "wait", Words(en="Needs the headset", de="Braucht das Headset")),
        Finding(
            "unknown",
            "wait",
            Words(
                en="The headset does not say if it measures them",
                de="Das Headset sagt nicht, ob es sie misst",
            ),
        ),
        Finding(
            "waiting",
            "wait",
            Words(
                en="Known once the headset is worn",
                de="Bekannt, sobald das Headset getragen wird",
            ),
        ),
        Finding(
            "inferred",
            "fail",
            Words(
                en="Computed from the upper body, not measured",
                de="Aus dem Oberkörper berechnet, nicht gemessen",
            ),
            remedy=_REMEDY,
        ),
        Finding(
            "lost", "fail", Words(en="Not tracked", de="Werden nicht verfolgt"), remedy=_REMEDY
        ),
        Finding("ok", "ok", Words(en="Both are measured", de="Beide werden gemessen")),
    ),
    run=_feet,
    mended_in_seconds=True,
)
