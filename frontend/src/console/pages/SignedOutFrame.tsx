/** The frame of the pages for people who are not signed in. */
import { Title } from "@mantine/core";
import { Mark } from "@shared/ui/Mark";
import type { JSX, ReactNode } from "react";
import { useTexts } from "../i18n";
import classes from "./Login.module.css";

interface FrontProps {
  readonly title: string;
  readonly children: ReactNode;
}

export function SignedOutFrame({ title, children }: FrontProps): JSX.Element {
  const { t } = useTexts();
  return (
    <main className={classes.page}>
      <div className={classes.figure}>
        <Echo />
      </div>
      <div className={classes.form}>
        <div className={classes.brand}>
          <Mark size={32} />
          {t("app.name")}
        </div>
        <Title order={1}>{title}</Title>
        {children}
      </div>
    </main>
  );
}

const STEPS = [
  { shift: 152, opacity: 0.22, width: 9, reach: "M148 118 L210 176 L262 214" },
  { shift: 78, opacity: 0.45, width: 10, reach: "M148 118 L216 150 L276 158" },
  { shift: 0, opacity: 1, width: 11, reach: "M148 118 L220 124 L288 96" },
] as const;

/** The sign-in picture: a reaching body and the same reach 125 and 350 ms later. */
function Echo(): JSX.Element {
  return (
    <svg viewBox="0 0 520 470" fill="none" aria-hidden="true">
      <path d="M40 420H480" stroke="var(--line-strong)" strokeWidth="2" />
      {STEPS.map((step) => (
        <g
          key={step.shift}
          transform={`translate(${step.shift} 20)`}
          stroke="var(--accent)"
          strokeWidth={step.width}
          strokeLinecap="round"
          strokeLinejoin="round"
          opacity={step.opacity}
        >
          <circle cx="140" cy="62" r="27" fill="var(--surface)" />
          <path d="M140 104V232" />
          <path d={step.reach} />
          <path d="M132 118 L96 174 L112 232" />
          <path d="M140 232 L116 314 L108 394" />
          <path d="M140 232 L170 312 L176 394" />
        </g>
      ))}
      <g fill="var(--ink-soft)" fontSize="15" fontFamily="inherit" textAnchor="middle">
        <text x="142" y="450">
          0 ms
        </text>
        <text x="220" y="450">
          125 ms
        </text>
        <text x="294" y="450">
          350 ms
        </text>
      </g>
    </svg>
  );
}
