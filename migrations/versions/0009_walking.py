"""Add walking: scenes, sets of walks and models.

Revision: 0009
Revises: 0008
"""

from collections.abc import Sequence

import sqlalchemy as sa
from alembic import op

import app.models.types


revision: str = '0009'
down_revision: str | None = '0008'
branch_labels: str | Sequence[str] | None = None
depends_on: str | Sequence[str] | None = None


def upgrade() -> None:
    """Apply this revision."""
    op.create_table('walking_scenes',
    sa.Column('key', sa.String(length=64), nullable=False),
    sa.Column('title', sa.String(length=200), nullable=False),
    sa.Column('text', sa.Text(), nullable=False),
    sa.Column('content_hash', sa.String(length=64), nullable=False),
    sa.Column('by', sa.String(length=100), nullable=False),
    sa.Column('at', app.models.types.UtcDateTime(timezone=True), nullable=False),
    sa.PrimaryKeyConstraint('key', name=op.f('pk_walking_scenes'))
    )
    op.create_table('walk_sets',
    sa.Column('id', sa.String(length=32), nullable=False),
    sa.Column('title', sa.String(length=200), nullable=False),
    sa.Column('kind', sa.String(length=20), nullable=False),
    sa.Column('origin', sa.JSON(), nullable=False),
    sa.Column('content_hash', sa.String(length=64), nullable=True),
    sa.Column('summary', sa.JSON(), nullable=False),
    sa.Column('by', sa.String(length=100), nullable=False),
    sa.Column('at', app.models.types.UtcDateTime(timezone=True), nullable=False),
    sa.CheckConstraint("kind IN ('human', 'synthetic')", name=op.f('ck_walk_sets_kind')),
    sa.ForeignKeyConstraint(['content_hash'], ['capture_contents.hash'], name=op.f('fk_walk_sets_content_hash_capture_contents')),
    sa.PrimaryKeyConstraint('id', name=op.f('pk_walk_sets'))
    )
    with op.batch_alter_table('walk_sets') as batch_op:
        batch_op.create_index(batch_op.f('ix_walk_sets_at'), ['at'], unique=False)
        batch_op.create_index(batch_op.f('ix_walk_sets_content_hash'), ['content_hash'], unique=False)
    op.create_table('walking_models',
    sa.Column('id', sa.String(length=32), nullable=False),
    sa.Column('title', sa.String(length=200), nullable=False),
    sa.Column('kind', sa.String(length=20), nullable=False),
    sa.Column('state', sa.String(length=20), nullable=False),
    sa.Column('walk_set_id', sa.String(length=32), nullable=True),
    sa.Column('walk_set', sa.JSON(), nullable=False),
    sa.Column('scene', sa.JSON(), nullable=True),
    sa.Column('options', sa.JSON(), nullable=False),
    sa.Column('content_hash', sa.String(length=64), nullable=True),
    sa.Column('summary', sa.JSON(), nullable=True),
    sa.Column('trouble', sa.Text(), nullable=True),
    sa.Column('by', sa.String(length=100), nullable=False),
    sa.Column('at', app.models.types.UtcDateTime(timezone=True), nullable=False),
    sa.Column('ended_at', app.models.types.UtcDateTime(timezone=True), nullable=True),
    sa.CheckConstraint("kind IN ('human', 'synthetic')", name=op.f('ck_walking_models_kind')),
    sa.CheckConstraint("state IN ('fitting', 'stopped', 'ready', 'failed')", name=op.f('ck_walking_models_state')),
    sa.ForeignKeyConstraint(['content_hash'], ['capture_contents.hash'], name=op.f('fk_walking_models_content_hash_capture_contents')),
    sa.ForeignKeyConstraint(['walk_set_id'], ['walk_sets.id'], name=op.f('fk_walking_models_walk_set_id_walk_sets')),
    sa.PrimaryKeyConstraint('id', name=op.f('pk_walking_models'))
    )
    with op.batch_alter_table('walking_models') as batch_op:
        batch_op.create_index(batch_op.f('ix_walking_models_at'), ['at'], unique=False)
        batch_op.create_index(batch_op.f('ix_walking_models_content_hash'), ['content_hash'], unique=False)
        batch_op.create_index(batch_op.f('ix_walking_models_walk_set_id'), ['walk_set_id'], unique=False)


def downgrade() -> None:
    """Revert this revision."""
    with op.batch_alter_table('walking_models') as batch_op:
        batch_op.drop_index(batch_op.f('ix_walking_models_walk_set_id'))
        batch_op.drop_index(batch_op.f('ix_walking_models_content_hash'))
        batch_op.drop_index(batch_op.f('ix_walking_models_at'))
    op.drop_table('walking_models')
    with op.batch_alter_table('walk_sets') as batch_op:
        batch_op.drop_index(batch_op.f('ix_walk_sets_content_hash'))
        batch_op.drop_index(batch_op.f('ix_walk_sets_at'))
    op.drop_table('walk_sets')
    op.drop_table('walking_scenes')
