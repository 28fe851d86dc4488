"""Tests that the bill of materials in the docs matches the lock files."""

import json

from tests.support.bill_of_materials import REPOSITORY, bill_of_materials


def test_the_bill_matches_the_lock_files() -> None:
    """The stored bill equals a newly generated one, so every dependency is listed."""
    stored = json.loads((REPOSITORY / "docs" / "sbom.cdx.json").read_text(encoding="utf-8"))
    assert stored == bill_of_materials()


def test_every_component_is_identified_and_needed() -> None:
    """Each part has a version and an identifier, and something depends on it."""
    bill = bill_of_materials()
    refs = {part["bom-ref"] for part in bill["components"]}
    needed = {ref for entry in bill["dependencies"] for ref in entry["dependsOn"]}
    assert len(refs) == len(bill["components"]) > 60
    assert refs <= needed
    assert {part["name"] for part in bill["components"]} >= {"fastapi", "sqlalchemy", "react"}
