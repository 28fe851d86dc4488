/**
 * A worker that runs the code at a blob's URL, which stands behind the # of its own URL.
 *
 * Three's loaders put the code of their workers together themselves. A worker that is started from
 * a blob has the page's policy, which forbids WebAssembly; this one has that of its own file.
 */
declare function importScripts(url: string): void;

importScripts(self.location.hash.slice(1));

export {};
