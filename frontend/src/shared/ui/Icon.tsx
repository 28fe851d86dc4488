/** The product's own line icons, drawn on a 24 px grid; always shown with words, never alone. */
import type { JSX } from "react";

const PATHS = {
  add: "M12 5v14M5 12h14",
  alert: "M12 4 2.8 20h18.4L12 4ZM12 10v4.5M12 17.2v.1",
  backspace: "M8.5 6H20v12H8.5L3 12 8.5 6ZM11.5 9.5l5 5M16.5 9.5l-5 5",
  back: "M14.5 5.5 8 12l6.5 6.5",
  body: "M12 7.5a2.5 2.5 0 1 0 0-5 2.5 2.5 0 0 0 0 5ZM4.5 10.5h15M12 10.5V15M12 15l-3.5 6.5M12 15l3.5 6.5",
  chart: "M4 4v16h16M8 16v-4M12.5 16V7.5M17 16v-6",
  check: "m5 12.5 4.5 4.5L19 7.5",
  close: "M6 6l12 12M18 6 6 18",
  clock: "M12 21a9 9 0 1 0 0-18 9 9 0 0 0 0 18ZM12 7.5V12l3 2",
  disk: "M12 8.5c4.4 0 7.5-1.1 7.5-2.5S16.4 3.5 12 3.5 4.5 4.6 4.5 6 7.6 8.5 12 8.5ZM4.5 6v12c0 1.4 3.1 2.5 7.5 2.5s7.5-1.1 7.5-2.5V6M4.5 12c0 1.4 3.1 2.5 7.5 2.5s7.5-1.1 7.5-2.5",
  document: "M6.5 3h7.5L18.5 7.5V21h-12V3ZM13.5 3v5h5M9.5 12.5h6M9.5 16.5h6",
  down: "m6 9.5 6 6 6-6",
  download: "M12 4v11M7 10.5l5 5 5-5M5 20h14",
  film: "M4 7h11v10H4zM15 10.8l5-2.8v8l-5-2.8",
  flag: "M6 21V4M6 4.5h11.5L15 9l2.5 4.5H6",
  flask:
    "M9 3.5h6M10 3.5v6L5 18.6a1.3 1.3 0 0 0 1.2 1.9h11.6a1.3 1.3 0 0 0 1.2-1.9L14 9.5v-6M7.5 15h9",
  foot: "M8 3.5v9.5l-3 3.5V20h14v-2.2c0-1.5-1-2.3-2.5-2.8l-3-1V3.5",
  form: "M5 3.5h14v17H5zM8.5 8.5l1.2 1.2 2-2.2M14 8.8h2M8.5 14.5l1.2 1.2 2-2.2M14 14.8h2",
  forward: "M9.5 5.5 16 12l-6.5 6.5",
  hand: "M7.5 12.5V6.2a1.5 1.5 0 0 1 3 0V11 4.7a1.5 1.5 0 0 1 3 0V11 6.2a1.5 1.5 0 0 1 3 0v8.3c0 3.5-2 6-5.2 6-3 0-4-1.5-5.3-4L3.8 13c.8-1.3 2.3-1.2 3.2 0l.5.7",
  headset: "M3.5 8.5h17v8h-5.2L13.6 14h-3.2l-1.7 2.5H3.5v-8ZM7 8.5V6.8h10v1.7",
  help: "M9.2 9.3A2.9 2.9 0 1 1 13.5 12c-.9.6-1.5 1.1-1.5 2.3M12 17.4v.1M12 21a9 9 0 1 0 0-18 9 9 0 0 0 0 18Z",
  height: "M12 3.5v17M8 7l4-3.5L16 7M8 17l4 3.5 4-3.5",
  home: "M4 11 12 4l8 7M6.5 9.5V20h11V9.5M10 20v-5.5h4V20",
  info: "M12 11v6M12 7.4v.1M12 21a9 9 0 1 0 0-18 9 9 0 0 0 0 18Z",
  joint:
    "M4 19.5 11 12.5M13.5 10 20 5.5M12.3 13.6a1.9 1.9 0 1 0 0-3.8 1.9 1.9 0 0 0 0 3.8ZM19.5 12.5a7.5 7.5 0 0 1-5.5 6.7",
  key: "M14.5 13a4.5 4.5 0 1 0-4-2.5L3.5 17.5V20.5h3v-2.5H9v-2.5h1.5l1.2-3.1M16 8v.1",
  link: "M10 14.5 14.5 10M9 11 6.2 13.8a3 3 0 1 0 4.2 4.2L13 15.2M11 8.8 13.8 6A3 3 0 1 1 18 10.2L15.2 13",
  list: "M9 6.5h11M9 12h11M9 17.5h11M4.5 6.5h.1M4.5 12h.1M4.5 17.5h.1",
  lock: "M6 11h12v9.5H6zM8.5 11V8a3.5 3.5 0 0 1 7 0v3",
  menu: "M4 6.5h16M4 12h16M4 17.5h16",
  minus: "M6 12h12",
  moon: "M20 14.5A8.3 8.3 0 0 1 9.5 4a8.3 8.3 0 1 0 10.5 10.5Z",
  note: "M5 4h14v11l-5 5H5V4ZM14 20v-5h5M8.5 9h7M8.5 12.5h4",
  pause: "M8.5 5.5v13M15.5 5.5v13",
  people:
    "M9 11.5a3.5 3.5 0 1 0 0-7 3.5 3.5 0 0 0 0 7ZM2.8 20v-1.2c0-2.9 2.6-4.8 6.2-4.8s6.2 1.9 6.2 4.8V20M15.5 4.8a3.4 3.4 0 0 1 0 6.4M17.5 14.4c2.3.7 3.7 2.2 3.7 4.4V20",
  play: "M8 5.2v13.6L19 12 8 5.2Z",
  plug: "M9 3.5V8M15 3.5V8M6.5 8h11v3.5a5.5 5.5 0 0 1-11 0V8ZM12 17v4",
  redo: "M5 12a7 7 0 1 1 2.2 5.1M5 12V6.5M5 12h5.5",
  search: "M10.5 17a6.5 6.5 0 1 0 0-13 6.5 6.5 0 0 0 0 13ZM15.5 15.5l5 5",
  sigma: "M17.5 7V4.5h-11L13 12l-6.5 7.5h11V17",
  skip: "M6 5.5v13L15 12 6 5.5ZM18 5.5v13",
  stop: "M6.5 6.5h11v11h-11z",
  sun: "M12 16a4 4 0 1 0 0-8 4 4 0 0 0 0 8ZM12 2.5v2M12 19.5v2M2.5 12h2M19.5 12h2M5.3 5.3l1.4 1.4M17.3 17.3l1.4 1.4M18.7 5.3l-1.4 1.4M6.7 17.3l-1.4 1.4",
  tablet: "M6 2.8h12v18.4H6zM11.2 18.2h1.6",
  talk: "M4 4.5h16v11.5h-8.5L7 20v-4H4V4.5Z",
  upload: "M12 15.5v-11M7 9l5-5 5 5M5 20h14",
  walk: "M13 6.2a2 2 0 1 0 0-4 2 2 0 0 0 0 4ZM8 12.5l1.5-4L13 8l2 3.5 3 1M12 12.5 10.5 16 7 21.5M12 12.5l2.5 3.5.8 5.5",
} as const;

export type IconName = keyof typeof PATHS;

interface IconProps {
  readonly name: IconName;
  readonly size?: number;
}

export function Icon({ name, size = 20 }: IconProps): JSX.Element {
  return (
    <svg
      aria-hidden="true"
      width={size}
      height={size}
      viewBox="0 0 24 24"
      fill="none"
      stroke="currentColor"
      strokeWidth={1.7}
      strokeLinecap="round"
      strokeLinejoin="round"
      style={{ flexShrink: 0 }}
    >
      <path d={PATHS[name]} />
    </svg>
  );
}
