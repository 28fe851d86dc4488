"""Check that the lab's trackers, if the session uses any, reach the headset and are aligned."""

from itertools import chain

from app.features.movement.live import LiveTracking
from app.features.record.lab_trackers import FOOT_LIMIT_M, LabTrackers
from app.features.record.preflight.check import Finding, Found, Situation, StateCheck
from app.texts import Words

_MM_PER_M = 1000.0


def _lab_trackers(situation: Situation) -> Found:
    followed = situation.context.part(LabTrackers).followed(situation.session.id)
    if followed is None:
        return Found("unneeded")
    link = followed.link
    name = (link.source,)
    now_s = situation.context.clock.monotonic_ns() / 1e9
    if doubled := link.doubled(now_s):
        return Found("two_on_limb", details=tuple(sorted(chain(*doubled.values()))))
    status = link.status(now_s)
    door = situation.context.part(LiveTracking).state_of(link.door)
    if status in ("no_reference", "silent") and door in (None, "failed"):
        return Found("door_closed" if door is None else "door_failed", details=name)
    step = link.step()
    if status != "aligned" or step is None or step.watched.alignment is None:
        return Found(status, details=name)
    if others := link.others(now_s):
        return Found("same_name", details=(*name, *others))
    foot_m = step.watched.alignment.quality.uncertainty_m
    return Found(
        "uncertain" if foot_m > FOOT_LIMIT_M else "aligned",
        value=round(_MM_PER_M * foot_m, 1),
        unit="mm",
        expected="at_most",
        limit=_MM_PER_M * FOOT_LIMIT_M,
        details=name,
    )


LAB_TRACKERS = StateCheck(
    key="lab_trackers",
    title=Words(en="Lab trackers", de="Tracker des Labors"),
    findings=(
        Finding(
            "unneeded",
            "unneeded",
            Words(en="The headset uses none", de="Das Headset verwendet keine"),
        ),
        Finding(
            "no_reference",
            "fail",
            Words(en="No tracker is on the headset", de="Kein Tracker ist am Headset"),
            remedy=Words(
                en="Fix a tracker to the headset, and give it the limb Head on the page Trackers.",
                de="Befestigen Sie einen Tracker am Headset und geben Sie ihm auf der Seite "
                "Tracker den Körperteil Kopf.",
            ),
        ),
        Finding(
            "two_on_limb",
            "fail",
            Words(
                en="Two trackers are on one limb; the first by name is used",
                de="Zwei Tracker sind an einem Körperteil; der erste nach dem Namen gilt",
            ),
            remedy=Words(
                en="Give each its own limb, or none, on the page Trackers.",
                de="Geben Sie auf der Seite Tracker jedem seinen eigenen Körperteil oder keinen.",
            ),
        ),
        Finding(
            "door_closed",
            "fail",
            Words(
                en="The door of the trackers is closed",
                de="Die Tür der Tracker ist geschlossen",
            ),
            remedy=Words(
                en="Open it on the page Trackers.",
                de="Öffnen Sie sie auf der Seite Tracker.",
            ),
        ),
        Finding(
            "door_failed",
            "fail",
            Words(
                en="The door of the trackers cannot be opened",
                de="Die Tür der Tracker lässt sich nicht öffnen",
            ),
            remedy=Words(
                en="The page Trackers says why: often another program uses its port.",
                de="Die Seite Tracker sagt, warum: oft verwendet ein anderes Programm den Port.",
            ),
        ),
        Finding(
            "silent",
            "fail",
            Words(
                en="The tracker on the headset sends nothing",
                de="Der Tracker am Headset sendet nichts",
            ),
            remedy=Words(
                en="Switch the trackers and their software on; the page Trackers shows whether "
                "packets arrive.",
                de="Schalten Sie die Tracker und ihre Software ein; die Seite Tracker zeigt, ob "
                "Pakete ankommen.",
            ),
        ),
        Finding("no_headset", "wait", Words(en="Needs the headset", de="Braucht das Headset")),
        Finding(
            "looking",
            "fail",
            Words(
                en="Not known yet where they are in the headset's room",
                de="Noch nicht bekannt, wo sie im Raum des Headsets sind",
            ),
            remedy=Words(
                en="Let the participant look around for 10 s: left and right, up and down.",
                de="Bitten Sie die Person, sich 10 s umzusehen: links und rechts, oben und unten.",
            ),
        ),
        Finding(
            "lost",
            "wait",
            Words(
                en="The headset was recentred; being aligned again",
                de="Das Headset wurde neu zentriert; wird neu ausgerichtet",
            ),
        ),
        Finding(
            "same_name",
            "fail",
            Words(
                en="Two senders have the same name; the first is used",
                de="Zwei Sender haben denselben Namen; der erste wird verwendet",
            ),
            remedy=Words(
                en="Switch the other one off, or give it another name.",
                de="Schalten Sie den anderen aus oder geben Sie ihm einen anderen Namen.",
            ),
        ),
        Finding(
            "uncertain",
            "fail",
            Words(
                en="A foot is known to ± {{value}} only",
                de="Ein Fuß ist nur auf ± {{value}} genau bekannt",
            ),
            remedy=Words(
                en="Let the participant look around further; check that the tracker sits firmly "
                "on the headset.",
                de="Bitten Sie die Person, sich weiter umzusehen; prüfen Sie, ob der Tracker fest "
                "am Headset sitzt.",
            ),
        ),
        Finding(
            "aligned",
            "ok",
            Words(
                en="Aligned, a foot is known to ± {{value}}",
                de="Ausgerichtet, ein Fuß ist auf ± {{value}} genau bekannt",
            ),
        ),
    ),
    run=_lab_trackers,
    mended_in_seconds=True,
)
