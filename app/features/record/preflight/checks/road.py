"""Check that whatever drives on the study's road is there, if the study has one.

Cars with our own driver always are. SUMO is an extra, and a process of somebody's own connects when
the phase begins: nothing is known of it before.
"""

from app.features.design.studies import protocol_of
from app.features.record.preflight.check import Finding, Found, Situation, StateCheck
from app.features.record.road import missing_for
from app.models import StudyVersion
from app.texts import Words


def _road(situation: Situation) -> Found:
    version = situation.db.get_one(StudyVersion, situation.session.study_version_id)
    road = protocol_of(version).road
    if road is None:
        return Found("unneeded")
    missing = missing_for(road)
    if missing:
        return Found("missing", details=(missing,))
    programs = road.programs()
    return Found("process" if programs else "ok", details=programs)


ROAD = StateCheck(
    key="road",
    title=Words(en="Traffic", de="Verkehr"),
    findings=(
        Finding(
            "unneeded",
            "unneeded",
            Words(en="No road to cross", de="Keine Straße zu überqueren"),
        ),
        Finding(
            "missing",
            "fail",
            Words(en="SUMO is not installed", de="SUMO ist nicht installiert"),
            remedy=Words(
                en="Run ./run crossing install traffic on the server's computer, or use a version "
                "of the study whose traffic has kind: cars.",
                de="Führen Sie auf dem Rechner des Servers ./run crossing install traffic aus, "
                "oder nehmen Sie eine Version der Studie, deren Verkehr kind: cars hat.",
            ),
        ),
        Finding(
            "process",
            "ok",
            Words(
                en="Start the programs that drive there before the phase",
                de="Starten Sie vor der Phase die Programme, die dort fahren",
            ),
        ),
        Finding("ok", "ok", Words(en="Ready", de="Bereit")),
    ),
    run=_road,
)
