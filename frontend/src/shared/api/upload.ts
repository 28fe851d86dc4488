/** Upload a file and follow how much of it was sent. */
import { accountHeader, errorFromBody, whyNotSent } from "./request";

export interface Stored<Answer> {
  readonly stored: Answer;
  /** False if the same content had been uploaded before. */
  readonly isNew: boolean;
}

/**
 * Post one or several files as one body; `onSent` is called with the fraction of bytes sent so far.
 *
 * Uses XMLHttpRequest because `fetch` does not report the progress of an upload.
 */
export function upload<Answer>(
  url: string,
  files: readonly File[],
  onSent: (share: number) => void,
): Promise<Stored<Answer>> {
  return new Promise((resolve, reject) => {
    const request = new XMLHttpRequest();
    request.open("POST", url);
    request.responseType = "json";
    for (const [name, value] of Object.entries(accountHeader())) {
      request.setRequestHeader(name, value);
    }
    request.upload.onprogress = (event) => {
      if (event.lengthComputable) onSent(event.loaded / event.total);
    };
    request.onload = () => {
      if (request.status >= 200 && request.status < 300) {
        resolve({ stored: request.response as Answer, isNew: request.status === 201 });
      } else reject(errorFromBody(request.status, request.response));
    };
    request.onerror = () => void whyNotSent(files).then(reject);
    request.send(files.length === 1 ? files[0] : new Blob([...files]));
  });
}
