/**
 * Units as types: a number that carries its unit cannot be passed to a function that expects
 * another.
 *
 * Values arrive from the server with the unit in their name (`active_s`, `latency_ms`); they are
 * branded once, on arrival, by the constructors below.
 */

declare const unit: unique symbol;
type Quantity<Unit extends string> = number & { readonly [unit]: Unit };

export type Seconds = Quantity<"s">;
export type Milliseconds = Quantity<"ms">;
export type Degrees = Quantity<"deg">;
export type Metres = Quantity<"m">;

export const seconds = (value: number): Seconds => value as Seconds;
export const milliseconds = (value: number): Milliseconds => value as Milliseconds;
export const degrees = (value: number): Degrees => value as Degrees;
export const metres = (value: number): Metres => value as Metres;

export const secondsFromMilliseconds = (value: Milliseconds): Seconds => seconds(value / 1000);
export const millisecondsFromSeconds = (value: Seconds): Milliseconds => milliseconds(value * 1000);
export const metresFromCentimetres = (value: number): Metres => metres(value / 100);
export const centimetresFromMetres = (value: Metres): number => value * 100;
