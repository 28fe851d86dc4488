"""Apply operations to a configuration, and compare versions; nothing is stored."""

from collections.abc import Iterable

from sqlalchemy.orm import Session

from app.errors import NotFound
from app.features.movement.avatar.schemas import (
    AvatarEdit,
    AvatarEdited,
    AvatarVersionDifference,
    GroupDifference,
    LossView,
    OperationProblemView,
    ValueChangeView,
)
from app.features.movement.avatar.service import (
    avatar_by_key,
    typed,
    unknown_humanoid,
    version_of,
)
from app.features.movement.avatar.views import version_view
from app.features.movement.humanoids import is_known
from app.protocol.avatar import configuration_of, file_of, loaded
from app.protocol.avatar_editing import (
    Edited,
    OperationProblem,
    ValueChange,
    Versions,
    differences,
    edited,
    fits_single_template,
    sums_by_group,
)
from app.protocol.avatar_joints import joint_views
from app.science.avatar.configuration import (
    AvatarProblem,
    AvatarSettingsError,
    Configuration,
    missing_part_problems,
)


def saved_versions(db: Session) -> Versions:
    """Return a function that gives the saved versions to which operations refer."""

    def version(key: str, number: int | None) -> Configuration:
        try:
            return typed(version_of(db, key, number))
        except NotFound as error:
            path = "key" if error.value == key else "version"
            raise AvatarSettingsError(
                (
                    AvatarProblem(
                        path,
                        f"{str(error)[:1].upper()}{str(error)[1:]}.",
                        value=error.value,
                        valid=error.valid,
                        remedy="Name a saved version.",
                    ),
                )
            ) from None

    return version


def edit(db: Session, request: AvatarEdit) -> AvatarEdited:
    """Apply operations to a configuration, and return what changes, what is lost, what is wrong."""
    try:
        before = configuration_of(request.configuration)
    except AvatarSettingsError as error:
        return AvatarEdited(
            configuration=request.configuration,
            content_hash=None,
            changed=[],
            lost=[],
            problems=_problems(OperationProblem(None, one) for one in error.problems),
            joints={},
            fits_single_template=False,
        )
    done = edited(before, request.operations, saved_versions(db))
    humanoid = done.configuration.humanoid
    if humanoid != before.humanoid or (humanoid is not None and not is_known(db, humanoid)):
        unworn = tuple(
            OperationProblem(None, one) for one in unknown_humanoid(db, done.configuration)
        )
        done = Edited(before, problems=unworn) if unworn else done
    incomplete = tuple(
        OperationProblem(None, one) for one in missing_part_problems(done.configuration)
    )
    return AvatarEdited(
        configuration=file_of(done.configuration),
        content_hash=loaded(done.configuration).content_hash,
        changed=change_views(done.changed),
        lost=[
            LossView(operation=one.operation, change=_change_view(one.change), reason=one.reason)
            for one in done.lost
        ],
        problems=_problems((*done.problems, *incomplete)),
        joints=joint_views(done.configuration),
        fits_single_template=fits_single_template(done.configuration),
    )


def version_difference(db: Session, key: str, old: int, new: int) -> AvatarVersionDifference:
    """Return how two versions of an avatar differ; raise NotFound."""
    avatar = avatar_by_key(db, key)
    before, after = version_of(db, key, old), version_of(db, key, new)
    changes = differences(typed(before), typed(after))
    return AvatarVersionDifference(
        key=key,
        title=avatar.title,
        old=version_view(before),
        new=version_view(after),
        same=not changes,
        changed=change_views(changes),
        groups=[
            GroupDifference(group=group, parts=list(parts), values=values)
            for group, (parts, values) in sums_by_group(changes).items()
        ],
    )


def change_views(changes: Iterable[ValueChange]) -> list[ValueChangeView]:
    """Return changed values for readers of the interface."""
    return [_change_view(one) for one in changes]


def _change_view(one: ValueChange) -> ValueChangeView:
    return ValueChangeView(
        path=one.path,
        field=one.field,
        part=one.part,
        axis=one.axis,
        groups=list(one.groups),
        unit=one.unit,
        old=one.old,
        new=one.new,
    )


def _problems(problems: Iterable[OperationProblem]) -> list[OperationProblemView]:
    return [
        OperationProblemView(
            operation=one.operation,
            path=one.problem.path,
            message=one.problem.message,
            value=one.problem.value,
            valid=one.problem.valid,
            remedy=one.problem.remedy,
        )
        for one in problems
    ]
