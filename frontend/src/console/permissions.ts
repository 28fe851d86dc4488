/** What the signed-in account may do. */
import { may, type Permission } from "@shared/permissions";
import { useAccount } from "./account";

export { may, type Permission, RULES } from "@shared/permissions";

/** Return a function that checks the permissions of the signed-in account. */
export function usePermissions(): (act: Permission) => boolean {
  const role = useAccount().data?.role;
  return (act) => role !== undefined && may(role, act);
}
