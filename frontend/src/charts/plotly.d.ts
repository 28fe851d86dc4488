/** Types for the part of Plotly that is used here. */
declare module "plotly.js-cartesian-dist-min" {
  interface Picture {
    readonly data: readonly unknown[];
    readonly layout: Readonly<Record<string, unknown>>;
  }
  interface PlotlyHandle {
    react(
      root: HTMLElement,
      data: readonly unknown[],
      layout: Readonly<Record<string, unknown>>,
      config: Readonly<Record<string, unknown>>,
    ): Promise<unknown>;
    purge(root: HTMLElement): void;
    downloadImage(
      picture: Picture,
      options: {
        readonly format: "png" | "svg";
        readonly width: number;
        readonly height: number;
        readonly scale: number;
        readonly filename: string;
      },
    ): Promise<string>;
    Plots: { resize(root: HTMLElement): void };
  }
  const plotly: PlotlyHandle;
  export default plotly;
}
