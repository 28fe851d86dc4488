/** The command that starts this server so that other devices reach it. */

/** The port of a server that was started without `--port`. */
const USUAL_PORT = "8321";

/** `port`: that of this page's address; another server may have the usual one. */
export function lanCommand(port: string): string {
  const isUsual = port === "" || port === USUAL_PORT;
  return isUsual ? "./run --lan" : `./run --lan --port ${port}`;
}
