/** Start the browser's download of an address under a file name. */
export function saveFile(address: string, fileName: string): void {
  const link = document.createElement("a");
  link.href = address;
  link.download = fileName;
  link.click();
}
