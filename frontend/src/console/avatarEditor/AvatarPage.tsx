/**
 * One avatar in the editor, from its newest version. An address that names a version leads to that
 * one in the list of versions; people who may not edit see that version itself.
 */
import { useQuery } from "@tanstack/react-query";
import { type JSX, useState } from "react";
import { useTexts } from "../i18n";
import { usePermissions } from "../permissions";
import { Loaded } from "../ui/Loaded";
import { useTitle } from "../ui/page";
import { type AvatarVersionDetail, type AvatarView, avatarQuery, versionQuery } from "./api";
import { AvatarEditor } from "./Editor";
import classes from "./Editor.module.css";
import { ToAvatars } from "./Head";
import { stateOfVersion } from "./useWork";

interface AvatarPageProps {
  readonly avatarKey: string;
  /** The number of a version, as in the address. */
  readonly version: string | undefined;
}

export function AvatarPage({ avatarKey, version }: AvatarPageProps): JSX.Element {
  const { t } = useTexts();
  useTitle(t("avatars.title"));
  const isReadOnly = !usePermissions()("body");
  // Always fetched: editing must start from what is stored now.
  const query = useQuery({
    ...avatarQuery(avatarKey),
    queryKey: ["avatars", avatarKey, "to-edit"],
    gcTime: 0,
    staleTime: Number.POSITIVE_INFINITY,
  });
  const linked = query.data?.versions.find(({ number }) => String(number) === version)?.number;
  const isOlder = isReadOnly && linked !== undefined && linked !== query.data?.newest.number;
  const older = useQuery({ ...versionQuery(avatarKey, linked ?? 0), enabled: isOlder });
  const first = isOlder ? older.data : query.data?.newest;
  if (query.data === undefined || first === undefined) {
    return (
      <div className={classes.page}>
        <ToAvatars />
        {query.data === undefined ? (
          <Loaded query={query}>{() => null}</Loaded>
        ) : (
          <Loaded query={older}>{() => null}</Loaded>
        )}
      </div>
    );
  }
  return <Opened avatar={query.data} first={first} linked={linked ?? null} asked={version} />;
}

interface OpenedProps {
  readonly avatar: AvatarView;
  readonly first: AvatarVersionDetail;
  readonly linked: number | null;
  readonly asked: string | undefined;
}

/**
 * The editor starts from one version, and stays there while others save theirs. After one's own
 * saving the same editor goes on from what was saved, with its tab, its focus and its undo.
 */
function Opened({ avatar: opened, first, linked, asked }: OpenedProps): JSX.Element {
  const { t } = useTexts();
  const [avatar, setAvatar] = useState(opened);
  const [base, setBase] = useState(first);
  useTitle(avatar.title);
  return (
    <AvatarEditor
      avatar={avatar}
      base={base}
      linked={linked}
      missing={asked !== undefined && linked === null ? asked : null}
      first={stateOfVersion(first, t("avatars.opened"))}
      onBase={setBase}
      onSaved={(saved) => {
        setAvatar(saved);
        setBase(saved.newest);
      }}
    />
  );
}
