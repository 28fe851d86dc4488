/** The part of Plotly that is used here. */
declare module "plotly.js-cartesian-dist-min" {
  interface PlotlyHandle {
    react(
      root: HTMLElement,
      data: readonly unknown[],
      layout: Readonly<Record<string, unknown>>,
      config: Readonly<Record<string, unknown>>,
    ): Promise<unknown>;
    purge(root: HTMLElement): void;
    Plots: { resize(root: HTMLElement): void };
  }
  const plotly: PlotlyHandle;
  export default plotly;
}
