/** A new password, entered twice, with a list of rules that are ticked off during typing. */
import { PasswordInput, Stack } from "@mantine/core";
import { type ApiError, isApiError } from "@shared/api/request";
import { Icon } from "@shared/ui/Icon";
import type { JSX, ReactNode } from "react";
import { useTexts } from "../../i18n";
import classes from "./NewPassword.module.css";
import {
  checkPassword,
  MAX_LENGTH,
  MIN_DIFFERENT,
  MIN_LENGTH,
  type PasswordChecks,
} from "./passwordRule";

interface Typed {
  readonly password: string;
  readonly repeated: string;
}

export const NOTHING_TYPED: Typed = { password: "", repeated: "" };

interface NewPasswordProps {
  readonly label: string;
  readonly username: string;
  readonly value: Typed;
  readonly error?: ReactNode;
  readonly onChange: (value: Typed) => void;
}

export function NewPassword(props: NewPasswordProps): JSX.Element {
  const { label, username, value, error, onChange } = props;
  const { t } = useTexts();
  const field = { autoComplete: "new-password", maxLength: MAX_LENGTH, required: true } as const;
  return (
    <Stack gap="sm">
      <PasswordInput
        {...field}
        label={label}
        withAsterisk={false}
        error={error}
        value={value.password}
        onChange={(event) => onChange({ ...value, password: event.currentTarget.value })}
      />
      <PasswordInput
        {...field}
        label={t("password.again")}
        withAsterisk={false}
        value={value.repeated}
        onChange={(event) => onChange({ ...value, repeated: event.currentTarget.value })}
      />
      <Rule checks={checkPassword(value.password, value.repeated, username.trim())} />
    </Stack>
  );
}

function Rule({ checks }: { readonly checks: PasswordChecks }): JSX.Element {
  const { t } = useTexts();
  const lines = [
    ["length", MIN_LENGTH],
    ["different", MIN_DIFFERENT],
    ["name", 0],
    ["same", 0],
  ] as const;
  return (
    <ul className={classes.rule} aria-label={t("password.rules")}>
      {lines.map(([name, least]) => (
        <li key={name} className={checks[name] ? classes.met : undefined}>
          {checks[name] ? <Icon name="check" size={16} /> : <Ring />}
          <span>
            {t(`password.rule.${name}`, { least })}
            <span className="visually-hidden">
              , {t(checks[name] ? "password.met" : "password.unmet")}
            </span>
          </span>
        </li>
      ))}
    </ul>
  );
}

function Ring(): JSX.Element {
  return (
    <svg width="16" height="16" viewBox="0 0 16 16" aria-hidden="true">
      <circle cx="8" cy="8" r="4.5" fill="none" stroke="var(--line-strong)" strokeWidth="1.5" />
    </svg>
  );
}

/** The server's errors about an account form, by field. */
interface FieldErrors {
  readonly username: string | null;
  readonly password: string | null;
  /** An error that belongs to no field. */
  readonly other: unknown;
}

const NONE: FieldErrors = { username: null, password: null, other: null };

/** The errors by field. The server repeats a rejected name, but never a password. */
export function fieldErrors(error: unknown): FieldErrors {
  if (error === null) return NONE;
  if (!isApiError(error, "invalid_input")) return { ...NONE, other: error };
  const message = sentence(error);
  return typeof error.value === "string"
    ? { ...NONE, username: message }
    : { ...NONE, password: message };
}

const sentence = ({ message, valid, remedy }: ApiError): string => {
  const parts = [message, typeof valid === "string" ? `valid: ${valid}` : "", remedy ?? ""];
  return parts
    .filter((part) => part !== "")
    .map((part) => part.charAt(0).toUpperCase() + part.slice(1).replace(/\.$/, ""))
    .join(". ")
    .concat(".");
};
