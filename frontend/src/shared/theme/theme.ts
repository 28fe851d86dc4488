/** The look of the product, as Mantine tokens; colours that carry meaning are in `tokens.css`. */
import {
  type ButtonProps,
  type ButtonStylesNames,
  createTheme,
  type DrawerProps,
  type DrawerStylesNames,
  type MantineColorsTuple,
  type ModalProps,
  type ModalStylesNames,
  type PaperProps,
  type TooltipProps,
} from "@mantine/core";
import type { CSSProperties } from "react";

const petrol: MantineColorsTuple = [
  "#eaf6f7",
  "#d2eaec",
  "#a5d6da",
  "#74bfc6",
  "#4aa9b2",
  "#2a929c",
  "#177b86",
  "#0e6873",
  "#0a545d",
  "#064047",
];
const slate: MantineColorsTuple = [
  "#f6f8f8",
  "#eef1f1",
  "#e1e6e6",
  "#cfd7d7",
  "#aab6b6",
  "#84928f",
  "#647371",
  "#4d5b5a",
  "#33403f",
  "#1a2424",
];
const night: MantineColorsTuple = [
  "#e6eded",
  "#b9c6c6",
  "#9fafaf",
  "#6d7e7e",
  "#3a4747",
  "#2c3737",
  "#212a2b",
  "#181f20",
  "#111718",
  "#0b1011",
];
const clay: MantineColorsTuple = [
  "#fdefea",
  "#f8dcd2",
  "#f0b7a4",
  "#e78f73",
  "#df6d4a",
  "#d3552f",
  "#bd4420",
  "#a23617",
  "#832a10",
  "#641f0b",
];

export const theme = createTheme({
  primaryColor: "petrol",
  // White text has a contrast of at least 4.5 : 1 on both shades.
  primaryShade: { light: 7, dark: 6 },
  colors: { petrol, gray: slate, dark: night, red: clay, clay },
  white: "#ffffff",
  black: "#1a2424",
  fontFamily: "var(--font)",
  fontFamilyMonospace:
    'ui-monospace, "SF Mono", "Cascadia Mono", Menlo, Consolas, "Liberation Mono", "DejaVu Sans Mono", "Noto Sans Mono", monospace',
  headings: {
    fontWeight: "620",
    sizes: {
      h1: { fontSize: "1.75rem", lineHeight: "1.25" },
      h2: { fontSize: "1.25rem", lineHeight: "1.35" },
      h3: { fontSize: "1rem", lineHeight: "1.4" },
    },
  },
  defaultRadius: "md",
  radius: { xs: "3px", sm: "5px", md: "8px", lg: "12px", xl: "20px" },
  cursorType: "pointer",
  focusRing: "auto",
  respectReducedMotion: true,
  // By names and types: naming the components themselves would load them into every page.
  components: {
    Paper: look<PaperProps>({ withBorder: true, radius: "lg", p: "lg" }),
    Modal: look<ModalProps, ModalStylesNames>(
      {
        radius: "lg",
        centered: true,
        transitionProps: { duration: 120 },
        overlayProps: { backgroundOpacity: 0.4 },
      },
      {
        title: { fontWeight: 620, fontSize: "1.125rem" },
        content: { padding: "4px 8px" },
        // It sticks to the very top, above the padding, where scrolled content would show.
        header: { top: "calc(-1 * var(--mantine-spacing-lg))" },
      },
    ),
    Drawer: look<DrawerProps, DrawerStylesNames>(
      { overlayProps: { backgroundOpacity: 0.4 } },
      // The title sticks to the very top, or scrolled content would show above it.
      { title: { fontWeight: 620, fontSize: "1.125rem" }, content: { paddingTop: 0 } },
    ),
    Button: look<ButtonProps, ButtonStylesNames>({}, { label: { fontWeight: 560 } }),
    Tooltip: look<TooltipProps>({ openDelay: 300, withArrow: true }),
  },
});

/** What a component looks like unless it is told otherwise. */
function look<Props, Part extends string = never>(
  defaultProps: Partial<Props>,
  styles: Partial<Record<Part, CSSProperties>> = {},
) {
  return { defaultProps, styles };
}
