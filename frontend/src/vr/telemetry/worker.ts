/** The file that runs in the worker. */
import type { FromWorker, Port, ToWorker } from "./port";
import { serveTelemetry } from "./service";

serveTelemetry(globalThis as unknown as Port<FromWorker, ToWorker>);
