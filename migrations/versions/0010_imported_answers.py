"""Add answers collected elsewhere.

Revision: 0010
Revises: 0009
"""

from collections.abc import Sequence

import sqlalchemy as sa
from alembic import op

import app.models.types


revision: str = '0010'
down_revision: str | None = '0009'
branch_labels: str | Sequence[str] | None = None
depends_on: str | Sequence[str] | None = None


def upgrade() -> None:
    """Apply this revision."""
    op.create_table('answer_imports',
    sa.Column('id', sa.String(length=32), nullable=False),
    sa.Column('study_id', sa.String(length=32), nullable=False),
    sa.Column('instrument_version_id', sa.String(length=32), nullable=False),
    sa.Column('instrument', sa.String(length=80), nullable=False),
    sa.Column('file_name', sa.String(length=200), nullable=False),
    sa.Column('content_hash', sa.String(length=64), nullable=False),
    sa.Column('mapping', sa.JSON(), nullable=False),
    sa.Column('forms', sa.Integer(), nullable=False),
    sa.Column('imported_at', app.models.types.UtcDateTime(timezone=True), nullable=False),
    sa.Column('imported_by', sa.String(length=100), nullable=False),
    sa.Column('undone_at', app.models.types.UtcDateTime(timezone=True), nullable=True),
    sa.Column('undone_by', sa.String(length=100), nullable=True),
    sa.Column('undone_reason', sa.Text(), nullable=True),
    sa.ForeignKeyConstraint(['instrument_version_id'], ['instrument_versions.id'], name=op.f('fk_answer_imports_instrument_version_id_instrument_versions')),
    sa.ForeignKeyConstraint(['study_id'], ['studies.id'], name=op.f('fk_answer_imports_study_id_studies')),
    sa.PrimaryKeyConstraint('id', name=op.f('pk_answer_imports'))
    )
    with op.batch_alter_table('answer_imports', schema=None) as batch_op:
        batch_op.create_index(batch_op.f('ix_answer_imports_study_id'), ['study_id'], unique=False)
        batch_op.create_index('uq_answer_imports_standing', ['study_id', 'instrument', 'content_hash'], unique=True, sqlite_where=sa.text('undone_at IS NULL'), postgresql_where=sa.text('undone_at IS NULL'))

    op.create_table('imported_forms',
    sa.Column('id', sa.String(length=32), nullable=False),
    sa.Column('import_id', sa.String(length=32), nullable=False),
    sa.Column('study_id', sa.String(length=32), nullable=False),
    sa.Column('line', sa.Integer(), nullable=False),
    sa.Column('participant_code', sa.String(length=80), nullable=False),
    sa.Column('condition', sa.String(length=80), nullable=False),
    sa.Column('in_study', sa.Boolean(), nullable=False),
    sa.Column('answered_on', sa.String(length=10), nullable=True),
    sa.Column('answers', sa.JSON(), nullable=False),
    sa.Column('scores', sa.JSON(), nullable=False),
    sa.ForeignKeyConstraint(['import_id'], ['answer_imports.id'], name=op.f('fk_imported_forms_import_id_answer_imports')),
    sa.ForeignKeyConstraint(['study_id'], ['studies.id'], name=op.f('fk_imported_forms_study_id_studies')),
    sa.PrimaryKeyConstraint('id', name=op.f('pk_imported_forms'))
    )
    with op.batch_alter_table('imported_forms', schema=None) as batch_op:
        batch_op.create_index('ix_imported_forms_code', ['study_id', 'participant_code'], unique=False)
        batch_op.create_index(batch_op.f('ix_imported_forms_import_id'), ['import_id'], unique=False)


def downgrade() -> None:
    """Revert this revision."""
    with op.batch_alter_table('imported_forms', schema=None) as batch_op:
        batch_op.drop_index(batch_op.f('ix_imported_forms_import_id'))
        batch_op.drop_index('ix_imported_forms_code')

    op.drop_table('imported_forms')
    with op.batch_alter_table('answer_imports', schema=None) as batch_op:
        batch_op.drop_index('uq_answer_imports_standing', sqlite_where=sa.text('undone_at IS NULL'), postgresql_where=sa.text('undone_at IS NULL'))
        batch_op.drop_index(batch_op.f('ix_answer_imports_study_id'))

    op.drop_table('answer_imports')
