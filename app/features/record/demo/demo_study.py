"""The study of the demo lab, made from the one that is shipped."""

from pathlib import Path
from typing import Any

import yaml

from app.features.design.studies import shipped_files

DEMO_KEY = "demo-lab"
ORIGIN = "reembodiment-latency"
PEOPLE = 12
PHASE_S = 10
"""The length of every timed phase: long enough for movement and contacts, short enough to wait."""
PAUSE_S = 1
"""The preparation before and the freeze after a task."""
TITLE = {"en": "Demo lab (simulated people)", "de": "Demo-Labor (simulierte Personen)"}
DESCRIPTION = {
    "en": (
        "Twelve simulated people act through a delayed copy of their body at 0, 125 and 350 ms of "
        "added latency, in phases of 10 s. Everything here is made up by the rehearsal's "
        "generator: it shows what the product does and says nothing about people."
    ),
    "de": (
        "Zwölf simulierte Personen handeln mit einer verzögerten Kopie ihres Körpers bei 0, 125 "
        "und 350 ms zusätzlicher Verzögerung, in Phasen von 10 s. Alles hier stammt vom Generator "
        "der Probe: Es zeigt, was das Produkt tut, und sagt nichts über Menschen."
    ),
}


def demo_code(number: int) -> str:
    """Return the code of a simulated person, counted from 1; they have no names."""
    return f"DEMO-{number:02d}"


def demo_yaml() -> str:
    """Return the study's file: the shipped study with short phases and a delayed copy.

    A delayed copy needs no physics, which takes longer than the phases.
    """
    origin = next(path for path in shipped_files().studies if path.stem == ORIGIN)
    return shortened(origin)


def shortened(origin: Path) -> str:
    """Return the demo lab's version of a study file."""
    study: dict[str, Any] = yaml.safe_load(origin.read_text(encoding="utf-8"))
    study |= {"key": DEMO_KEY, "title": TITLE, "description": DESCRIPTION, "avatar": "delayed_copy"}
    study.pop("avatar_configuration", None)
    procedure = study["procedure"]
    steps = [*procedure["before"], *procedure["block"]["phases"], *procedure["after"]]
    for step in steps:
        if "duration_s" in step:
            step["duration_s"] = PHASE_S
        for pause in {"preparation_s", "freeze_s"} & step.keys():
            step[pause] = PAUSE_S
    text: str = yaml.safe_dump(study, allow_unicode=True, sort_keys=False)
    return text
