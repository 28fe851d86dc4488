import type { JSX } from "react";
import classes from "./Network.module.css";

interface QrCodeProps {
  readonly svg: string;
  readonly alt: string;
  readonly caption?: string;
}

/** A QR code that the server drew, on white in either appearance: cameras need the contrast. */
export function QrCode({ svg, alt, caption }: QrCodeProps): JSX.Element {
  return (
    <figure className={classes.figure}>
      <img
        className={classes.qr}
        alt={alt}
        src={`data:image/svg+xml;charset=utf-8,${encodeURIComponent(svg)}`}
      />
      {caption !== undefined && <figcaption>{caption}</figcaption>}
    </figure>
  );
}
