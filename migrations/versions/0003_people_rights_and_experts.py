"""Add people, participants' rights and experts.

Revision: 0003
Revises: 0002
"""

from collections.abc import Sequence

import sqlalchemy as sa
from alembic import op

import app.models.types


revision: str = '0003'
down_revision: str | None = '0002'
branch_labels: str | Sequence[str] | None = None
depends_on: str | Sequence[str] | None = None


KIND = "kind IN ('people', 'simulated', 'test', 'expert')"
OLD_KIND = "kind IN ('people', 'simulated', 'test')"


def _kinds(condition: str) -> None:
    """Replace the constraint on the kinds of sessions."""
    for table in ('ledgers', 'sessions'):
        name = op.f(f'ck_{table}_kind')
        with op.batch_alter_table(table) as batch_op:
            batch_op.drop_constraint(name, type_='check')
            batch_op.create_check_constraint(name, condition)


def upgrade() -> None:
    """Apply this revision."""
    op.create_table('audit_entries',
    sa.Column('seq', sa.Integer(), autoincrement=False, nullable=False),
    sa.Column('at', app.models.types.UtcDateTime(timezone=True), nullable=False),
    sa.Column('actor', sa.String(length=100), nullable=False),
    sa.Column('action', sa.String(length=60), nullable=False),
    sa.Column('subject', sa.String(length=200), nullable=False),
    sa.Column('details', sa.Text(), nullable=False),
    sa.Column('previous_hash', sa.String(length=64), nullable=False),
    sa.Column('hash', sa.String(length=64), nullable=False),
    sa.PrimaryKeyConstraint('seq', name=op.f('pk_audit_entries'))
    )
    with op.batch_alter_table('audit_entries', schema=None) as batch_op:
        batch_op.create_index(batch_op.f('ix_audit_entries_action'), ['action'], unique=False)
        batch_op.create_index(batch_op.f('ix_audit_entries_actor'), ['actor'], unique=False)

    op.create_table('audit_head',
    sa.Column('id', sa.Integer(), autoincrement=False, nullable=False),
    sa.Column('seq', sa.Integer(), nullable=False),
    sa.Column('hash', sa.String(length=64), nullable=False),
    sa.PrimaryKeyConstraint('id', name=op.f('pk_audit_head'))
    )
    op.create_table('calibrations',
    sa.Column('id', sa.String(length=32), nullable=False),
    sa.Column('equipment', sa.String(length=120), nullable=False),
    sa.Column('motion_to_photon_s', sa.Double(), nullable=False),
    sa.Column('sd_s', sa.Double(), nullable=False),
    sa.Column('samples', sa.Integer(), nullable=False),
    sa.Column('method', sa.String(length=400), nullable=False),
    sa.Column('measured_on', sa.String(length=10), nullable=False),
    sa.Column('note', sa.String(length=2000), nullable=False),
    sa.Column('by', sa.String(length=100), nullable=False),
    sa.Column('at', app.models.types.UtcDateTime(timezone=True), nullable=False),
    sa.Column('retired_at', app.models.types.UtcDateTime(timezone=True), nullable=True),
    sa.Column('retired_by', sa.String(length=100), nullable=True),
    sa.Column('retired_reason', sa.String(length=2000), nullable=True),
    sa.PrimaryKeyConstraint('id', name=op.f('pk_calibrations'))
    )
    op.create_table('invitations',
    sa.Column('id', sa.String(length=32), nullable=False),
    sa.Column('token_hash', sa.String(length=64), nullable=False),
    sa.Column('role', sa.String(length=20), nullable=False),
    sa.Column('note', sa.String(length=80), nullable=False),
    sa.Column('all_studies', sa.Boolean(), nullable=False),
    sa.Column('studies', sa.JSON(), nullable=False),
    sa.Column('created_by', sa.String(length=80), nullable=False),
    sa.Column('created_at', app.models.types.UtcDateTime(timezone=True), nullable=False),
    sa.Column('expires_at', app.models.types.UtcDateTime(timezone=True), nullable=False),
    sa.Column('used_at', app.models.types.UtcDateTime(timezone=True), nullable=True),
    sa.Column('account_id', sa.String(length=32), nullable=True),
    sa.Column('revoked_at', app.models.types.UtcDateTime(timezone=True), nullable=True),
    sa.CheckConstraint("role IN ('admin', 'experimenter', 'operator', 'analyst')", name=op.f('ck_invitations_role')),
    sa.ForeignKeyConstraint(['account_id'], ['accounts.id'], name=op.f('fk_invitations_account_id_accounts')),
    sa.PrimaryKeyConstraint('id', name=op.f('pk_invitations')),
    sa.UniqueConstraint('token_hash', name=op.f('uq_invitations_token_hash'))
    )
    op.create_table('study_members',
    sa.Column('account_id', sa.String(length=32), nullable=False),
    sa.Column('study_id', sa.String(length=32), nullable=False),
    sa.ForeignKeyConstraint(['account_id'], ['accounts.id'], name=op.f('fk_study_members_account_id_accounts')),
    sa.ForeignKeyConstraint(['study_id'], ['studies.id'], name=op.f('fk_study_members_study_id_studies')),
    sa.PrimaryKeyConstraint('account_id', 'study_id', name=op.f('pk_study_members'))
    )
    with op.batch_alter_table('study_members', schema=None) as batch_op:
        batch_op.create_index(batch_op.f('ix_study_members_study_id'), ['study_id'], unique=False)

    op.create_table('copies_made',
    sa.Column('id', sa.String(length=32), nullable=False),
    sa.Column('kind', sa.String(length=20), nullable=False),
    sa.Column('study_id', sa.String(length=32), nullable=True),
    sa.Column('session_kind', sa.String(length=20), nullable=True),
    sa.Column('participant_id', sa.String(length=32), nullable=True),
    sa.Column('place', sa.String(length=400), nullable=False),
    sa.Column('sessions', sa.Integer(), nullable=True),
    sa.Column('bytes', sa.BigInteger(), nullable=True),
    sa.Column('by', sa.String(length=100), nullable=False),
    sa.Column('at', app.models.types.UtcDateTime(timezone=True), nullable=False),
    sa.Column('destroyed_at', app.models.types.UtcDateTime(timezone=True), nullable=True),
    sa.Column('destroyed_by', sa.String(length=100), nullable=True),
    sa.ForeignKeyConstraint(['participant_id'], ['participants.id'], name=op.f('fk_copies_made_participant_id_participants')),
    sa.ForeignKeyConstraint(['study_id'], ['studies.id'], name=op.f('fk_copies_made_study_id_studies')),
    sa.PrimaryKeyConstraint('id', name=op.f('pk_copies_made'))
    )
    with op.batch_alter_table('copies_made', schema=None) as batch_op:
        batch_op.create_index(batch_op.f('ix_copies_made_study_id'), ['study_id'], unique=False)

    op.create_table('erasures',
    sa.Column('id', sa.String(length=32), nullable=False),
    sa.Column('study_id', sa.String(length=32), nullable=False),
    sa.Column('participant_id', sa.String(length=32), nullable=False),
    sa.Column('sessions', sa.JSON(), nullable=False),
    sa.Column('removed', sa.JSON(), nullable=False),
    sa.Column('remaining', sa.JSON(), nullable=False),
    sa.Column('by', sa.String(length=100), nullable=False),
    sa.Column('at', app.models.types.UtcDateTime(timezone=True), nullable=False),
    sa.ForeignKeyConstraint(['participant_id'], ['participants.id'], name=op.f('fk_erasures_participant_id_participants')),
    sa.ForeignKeyConstraint(['study_id'], ['studies.id'], name=op.f('fk_erasures_study_id_studies')),
    sa.PrimaryKeyConstraint('id', name=op.f('pk_erasures')),
    sa.UniqueConstraint('participant_id', name=op.f('uq_erasures_participant_id'))
    )
    with op.batch_alter_table('erasures', schema=None) as batch_op:
        batch_op.create_index(batch_op.f('ix_erasures_study_id'), ['study_id'], unique=False)

    op.create_table('suggestions',
    sa.Column('id', sa.String(length=32), nullable=False),
    sa.Column('study_version_id', sa.String(length=32), nullable=False),
    sa.Column('session_id', sa.String(length=32), nullable=True),
    sa.Column('about', sa.String(length=80), nullable=False),
    sa.Column('body', sa.Text(), nullable=False),
    sa.Column('status', sa.String(length=20), nullable=False),
    sa.Column('adopted_in', sa.Integer(), nullable=True),
    sa.Column('by', sa.String(length=100), nullable=False),
    sa.Column('at', app.models.types.UtcDateTime(timezone=True), nullable=False),
    sa.Column('decided_by', sa.String(length=100), nullable=True),
    sa.Column('decided_at', app.models.types.UtcDateTime(timezone=True), nullable=True),
    sa.ForeignKeyConstraint(['session_id'], ['sessions.id'], name=op.f('fk_suggestions_session_id_sessions')),
    sa.ForeignKeyConstraint(['study_version_id'], ['study_versions.id'], name=op.f('fk_suggestions_study_version_id_study_versions')),
    sa.PrimaryKeyConstraint('id', name=op.f('pk_suggestions'))
    )
    with op.batch_alter_table('suggestions', schema=None) as batch_op:
        batch_op.create_index(batch_op.f('ix_suggestions_session_id'), ['session_id'], unique=False)
        batch_op.create_index(batch_op.f('ix_suggestions_study_version_id'), ['study_version_id'], unique=False)

    op.create_table('answer_corrections',
    sa.Column('id', sa.String(length=32), nullable=False),
    sa.Column('submission_id', sa.String(length=32), nullable=False),
    sa.Column('item', sa.String(length=80), nullable=False),
    sa.Column('previous_number', sa.Double(), nullable=True),
    sa.Column('previous_text', sa.Text(), nullable=True),
    sa.Column('value_number', sa.Double(), nullable=True),
    sa.Column('value_text', sa.Text(), nullable=True),
    sa.Column('reason', sa.String(length=2000), nullable=False),
    sa.Column('by', sa.String(length=100), nullable=False),
    sa.Column('at', app.models.types.UtcDateTime(timezone=True), nullable=False),
    sa.ForeignKeyConstraint(['submission_id', 'item'], ['answers.submission_id', 'answers.item'], name=op.f('fk_answer_corrections_submission_id_item_answers')),
    sa.PrimaryKeyConstraint('id', name=op.f('pk_answer_corrections'))
    )
    with op.batch_alter_table('answer_corrections', schema=None) as batch_op:
        batch_op.create_index(batch_op.f('ix_answer_corrections_submission_id'), ['submission_id'], unique=False)

    with op.batch_alter_table('accounts', schema=None) as batch_op:
        batch_op.add_column(sa.Column('all_studies', sa.Boolean(), server_default=sa.true(), nullable=False))

    _kinds(KIND)


def downgrade() -> None:
    """Revert this revision."""
    _kinds(OLD_KIND)
    with op.batch_alter_table('accounts', schema=None) as batch_op:
        batch_op.drop_column('all_studies')

    with op.batch_alter_table('answer_corrections', schema=None) as batch_op:
        batch_op.drop_index(batch_op.f('ix_answer_corrections_submission_id'))

    op.drop_table('answer_corrections')
    with op.batch_alter_table('suggestions', schema=None) as batch_op:
        batch_op.drop_index(batch_op.f('ix_suggestions_study_version_id'))
        batch_op.drop_index(batch_op.f('ix_suggestions_session_id'))

    op.drop_table('suggestions')
    with op.batch_alter_table('erasures', schema=None) as batch_op:
        batch_op.drop_index(batch_op.f('ix_erasures_study_id'))

    op.drop_table('erasures')
    with op.batch_alter_table('copies_made', schema=None) as batch_op:
        batch_op.drop_index(batch_op.f('ix_copies_made_study_id'))

    op.drop_table('copies_made')
    with op.batch_alter_table('study_members', schema=None) as batch_op:
        batch_op.drop_index(batch_op.f('ix_study_members_study_id'))

    op.drop_table('study_members')
    op.drop_table('invitations')
    op.drop_table('calibrations')
    op.drop_table('audit_head')
    with op.batch_alter_table('audit_entries', schema=None) as batch_op:
        batch_op.drop_index(batch_op.f('ix_audit_entries_actor'))
        batch_op.drop_index(batch_op.f('ix_audit_entries_action'))

    op.drop_table('audit_entries')
