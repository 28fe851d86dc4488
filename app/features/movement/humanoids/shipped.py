"""Store the bodies that come with the product when a server first starts on a database.

The folder `bodies` has the file of each model and, beside it, the measures taken from the file, so
that a start needs neither to read nor to measure a model.
"""

import hashlib
import json
from datetime import datetime
from typing import Final

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.features.movement.files import store_bytes
from app.features.movement.humanoids.service import named_bodies
from app.models import HumanoidRow
from app.resources import bodies_dir

SHIPPED_BODIES: Final = ("neutral", "female", "male")
"""The names of the shipped bodies, which are those of their files."""
_PRODUCT = "system"


def add_shipped_bodies(db: Session, now: datetime) -> None:
    """Store the shipped bodies that the database does not have yet.

    A body is stored without a name if another body has its name, given by the lab or by an earlier
    release: a name never comes to mean another body.
    """
    models = {name: (bodies_dir() / f"{name}.glb").read_bytes() for name in SHIPPED_BODIES}
    hashes = {name: hashlib.sha256(data).hexdigest() for name, data in models.items()}
    query = select(HumanoidRow.hash).where(HumanoidRow.hash.in_(list(hashes.values())))
    stored = set(db.scalars(query))
    if stored == set(hashes.values()):
        return
    taken = named_bodies(db)
    for name, data in models.items():
        if hashes[name] in stored:
            continue
        measures = json.loads((bodies_dir() / f"{name}.json").read_text(encoding="utf-8"))
        store_bytes(db, hashes[name], data)
        db.add(
            HumanoidRow(
                **measures,
                hash=hashes[name],
                file_name=f"{name}.glb",
                name=None if name in taken else name,
                origin="shipped",
                by=_PRODUCT,
                at=now,
            )
        )
        db.flush()
