"""QR codes of addresses, for pages and for terminals."""

import io

import segno


def qr_svg(text: str) -> str:
    """A QR code as an SVG element without a size of its own."""
    buffer = io.BytesIO()
    segno.make(text, error="m").save(
        buffer, kind="svg", xmldecl=False, svgns=True, border=2, scale=1, omitsize=True
    )
    return buffer.getvalue().decode()


def qr_terminal(text: str) -> str:
    """A QR code in half blocks, two rows a line."""
    buffer = io.StringIO()
    segno.make(text, error="l").terminal(buffer, compact=True, border=2)
    return buffer.getvalue()
