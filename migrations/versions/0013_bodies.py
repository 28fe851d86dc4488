"""Name bodies, keep their licences and sizes, and record which body each phase wore.

Revision: 0013
Revises: 0012
"""

from collections.abc import Sequence

import sqlalchemy as sa
from alembic import op


revision: str = "0013"
down_revision: str | None = "0012"
branch_labels: str | Sequence[str] | None = None
depends_on: str | Sequence[str] | None = None

COUNTS = ("triangles", "vertices", "textures")


def upgrade() -> None:
    """Apply this revision."""
    with op.batch_alter_table("humanoids") as batch_op:
        batch_op.add_column(sa.Column("name", sa.String(length=80), nullable=True))
        batch_op.add_column(sa.Column("title", sa.String(length=200), nullable=True))
        batch_op.add_column(
            sa.Column("origin", sa.String(length=20), server_default="uploaded", nullable=False)
        )
        batch_op.add_column(sa.Column("licence", sa.JSON(), nullable=True))
        batch_op.add_column(sa.Column("confirmed", sa.JSON(), nullable=True))
        for count in COUNTS:
            batch_op.add_column(sa.Column(count, sa.Integer(), nullable=True))
        batch_op.create_unique_constraint(op.f("uq_humanoids_name"), ["name"])
        batch_op.create_check_constraint(
            op.f("ck_humanoids_origin"), "origin IN ('shipped', 'uploaded')"
        )
    op.add_column("phases", sa.Column("body", sa.String(length=80), nullable=True))


def downgrade() -> None:
    """Revert this revision."""
    op.drop_column("phases", "body")
    with op.batch_alter_table("humanoids") as batch_op:
        batch_op.drop_constraint(op.f("ck_humanoids_origin"), type_="check")
        batch_op.drop_constraint(op.f("uq_humanoids_name"), type_="unique")
        for name in (*reversed(COUNTS), "confirmed", "licence", "origin", "title", "name"):
            batch_op.drop_column(name)
