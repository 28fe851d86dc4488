// Unpacks Chromium into TMPDIR and prints the path of its program.
import chromium from "@sparticuz/chromium";

process.stdout.write(await chromium.executablePath());
