"""Store the runs of a study's road, their records, and how participants crossed.

Revision: 0019
Revises: 0018
"""

from collections.abc import Sequence

import sqlalchemy as sa
from alembic import op

import app.models.types


revision: str = "0019"
down_revision: str | None = "0018"
branch_labels: str | Sequence[str] | None = None
depends_on: str | Sequence[str] | None = None


def upgrade() -> None:
    """Apply this revision."""
    op.create_table(
        "road_runs",
        sa.Column("id", sa.String(length=32), nullable=False),
        sa.Column("session_id", sa.String(length=32), nullable=False),
        sa.Column("phase_id", sa.Integer(), nullable=False),
        sa.Column("part", sa.Integer(), nullable=False),
        sa.Column("seed", sa.Integer(), nullable=False),
        sa.Column("begins_at_s", sa.Double(), nullable=False),
        sa.Column("header", sa.JSON(), nullable=False),
        sa.Column("began_at", app.models.types.UtcDateTime(timezone=True), nullable=False),
        sa.Column("ended_at", app.models.types.UtcDateTime(timezone=True), nullable=True),
        sa.Column("ended", sa.String(length=20), nullable=False),
        sa.Column("reason", sa.String(length=400), nullable=False),
        sa.Column("steps", sa.Integer(), nullable=False),
        sa.Column("guesses", sa.Integer(), nullable=False),
        sa.Column("worst_guess_m", sa.Double(), nullable=True),
        sa.Column("timing", sa.JSON(), nullable=False),
        sa.Column("sha256", sa.String(length=64), nullable=True),
        sa.ForeignKeyConstraint(
            ["session_id", "phase_id"],
            ["phases.session_id", "phases.phase_id"],
            name=op.f("fk_road_runs_session_id_phases"),
        ),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_road_runs")),
    )
    op.create_index("ix_road_runs_phase", "road_runs", ["session_id", "phase_id"])
    op.create_table(
        "road_chunks",
        sa.Column("run_id", sa.String(length=32), nullable=False),
        sa.Column("number", sa.Integer(), autoincrement=False, nullable=False),
        sa.Column("session_id", sa.String(length=32), nullable=False),
        sa.Column("data", sa.LargeBinary(), nullable=False),
        sa.ForeignKeyConstraint(
            ["run_id"], ["road_runs.id"], name=op.f("fk_road_chunks_run_id_road_runs")
        ),
        sa.ForeignKeyConstraint(
            ["session_id"], ["sessions.id"], name=op.f("fk_road_chunks_session_id_sessions")
        ),
        sa.PrimaryKeyConstraint("run_id", "number", name=op.f("pk_road_chunks")),
    )
    op.create_index(op.f("ix_road_chunks_session_id"), "road_chunks", ["session_id"])
    op.create_table(
        "road_crossings",
        sa.Column("run_id", sa.String(length=32), nullable=False),
        sa.Column("number", sa.Integer(), autoincrement=False, nullable=False),
        sa.Column("session_id", sa.String(length=32), nullable=False),
        sa.Column("phase_id", sa.Integer(), nullable=False),
        sa.Column("steps_on_s", sa.Double(), nullable=True),
        sa.Column("steps_off_s", sa.Double(), nullable=True),
        sa.Column("is_across", sa.Boolean(), nullable=False),
        sa.Column("waited_s", sa.Double(), nullable=False),
        sa.Column("gap_accepted_s", sa.Double(), nullable=True),
        sa.Column("gaps_refused_s", sa.JSON(), nullable=False),
        sa.Column("least_time_to_collision_s", sa.Double(), nullable=True),
        sa.Column("least_post_encroachment_s", sa.Double(), nullable=True),
        sa.Column("closest_m", sa.Double(), nullable=True),
        sa.Column("collision_car", sa.String(length=80), nullable=True),
        sa.Column("collision_s", sa.Double(), nullable=True),
        sa.Column("collision_speed_m_s", sa.Double(), nullable=True),
        sa.ForeignKeyConstraint(
            ["run_id"], ["road_runs.id"], name=op.f("fk_road_crossings_run_id_road_runs")
        ),
        sa.ForeignKeyConstraint(
            ["session_id"], ["sessions.id"], name=op.f("fk_road_crossings_session_id_sessions")
        ),
        sa.PrimaryKeyConstraint("run_id", "number", name=op.f("pk_road_crossings")),
    )
    op.create_index(op.f("ix_road_crossings_session_id"), "road_crossings", ["session_id"])


def downgrade() -> None:
    """Revert this revision."""
    op.drop_index(op.f("ix_road_crossings_session_id"), table_name="road_crossings")
    op.drop_table("road_crossings")
    op.drop_index(op.f("ix_road_chunks_session_id"), table_name="road_chunks")
    op.drop_table("road_chunks")
    op.drop_index("ix_road_runs_phase", table_name="road_runs")
    op.drop_table("road_runs")
