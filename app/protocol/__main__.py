"""Writes the pages' table of step kinds: `python -m app.protocol > FILE` (`PAGE_TABLE`)."""

import json
import sys
from collections.abc import Iterator

from app.protocol.step_kinds import PHASES, STEP_KINDS, StepKindSpec, Words

PAGE_TABLE = "frontend/src/console/stepKinds.generated.ts"
_HEAD = """\
/**
 * The kinds of a session's steps, and their words. Generated from `app/protocol/step_kinds.py`:
 *
 *     python -m app.protocol > {file}
 */
import type {{ Limb, StepKind }} from "@shared/api/types";
import type {{ IconName }} from "@shared/ui/Icon";

/**
 * `limbs`: those it is done with, at the boxes; none where it needs none. `counts`: its phases are
 * the study's data. `isCompletedByButton`: the experimenter ends it with a plain button.
 */
export interface StepKindSpec {{
  readonly family: "timed" | "form" | "by hand";
  readonly icon: IconName;
  readonly limbs: readonly Limb[];
  readonly counts: boolean;
  readonly isCompletedByButton: boolean;
}}

export const STEP_KINDS: Readonly<Record<StepKind, StepKindSpec>> = {{
"""


def page_table() -> str:
    """The source text of `PAGE_TABLE`: what kinds there are, and a table of words per language."""
    kinds = "".join(f"  {key}: {_typescript(spec)},\n" for key, spec in STEP_KINDS.items())
    english, german = (
        "".join(
            f"  {json.dumps(key)}: {json.dumps(words[language], ensure_ascii=False)},\n"
            for key, words in _texts()
        )
        for language in ("en", "de")
    )
    return (
        f"{_HEAD.format(file=PAGE_TABLE)}{kinds}}};\n\n"
        f"export const stepKindsEn = {{\n{english}}};\n\n"
        "export const stepKindsDe: Readonly<Record<keyof typeof stepKindsEn, string>> = {\n"
        f"{german}}};\n"
    )


def _typescript(spec: StepKindSpec) -> str:
    limbs = [str(limb) for limb in spec.phases if limb is not None]
    fields = {
        "family": spec.family,
        "icon": spec.icon,
        "limbs": limbs,
        "counts": spec.counts,
        "isCompletedByButton": spec.done is not None,
    }
    return "{ " + ", ".join(f"{name}: {json.dumps(value)}" for name, value in fields.items()) + " }"


def _texts() -> Iterator[tuple[str, Words]]:
    """Every text with its key: `step.` a title, `guide.` guidance, `do.` what a button says."""
    for kind, spec in STEP_KINDS.items():
        yield f"step.{kind}", spec.name
        if spec.guidance is not None:
            yield f"guide.{kind}", spec.guidance
        if spec.done is not None:
            yield f"do.complete.{kind}", spec.done
        for limb, words in spec.phases.items():
            place = kind if limb is None else f"{kind}.{limb}"
            if limb is not None:
                yield f"step.{place}", words.title
            yield f"guide.{place}", words.guidance
            yield f"do.begin.{place}", words.begin
    for key, words in PHASES.items():
        yield f"validity.phase.{key}", words.in_a_sentence


if __name__ == "__main__":
    sys.stdout.write(page_table())
