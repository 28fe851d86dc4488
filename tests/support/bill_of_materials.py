"""Generate the CycloneDX bill of materials of the product from the two lock files.

`python -m tests.support.bill_of_materials > docs/sbom.cdx.json` rewrites it; a test compares the
file, so a dependency cannot be added without being listed. The locks name every package with its
hashes, so nothing needs to be installed or downloaded.
"""

import json
import re
import sys
import uuid
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from app import __version__

REPOSITORY = Path(__file__).resolve().parents[2]
PINNED = re.compile(r"^(?P<name>[a-z0-9._-]+)==(?P<version>[^ ;\\]+)")
HASHED = re.compile(r"--hash=sha256:(?P<hash>[0-9a-f]{64})")
BY = re.compile(r"^    #(?: via)? +(?P<who>[a-z0-9._-]+)")
NAMESPACE = uuid.UUID("5b4f7f9e-7a51-4d0c-9a3a-6a4a3f0f7d11")
# They are listed as dependencies, since the pages are built where no development dependencies
# are installed; no page contains them.
BUILD_TOOLS = {"marked", "vite", "@vitejs/plugin-react"}
Json = dict[str, Any]


def bill_of_materials() -> Json:
    """Return the bill as a CycloneDX 1.6 document; equal locks give an equal bill."""
    components = [*_python(), *_javascript()]
    depended = {part["bom-ref"]: sorted(part.pop("needed_by")) for part in components}
    root = {
        "type": "application",
        "bom-ref": "reembody",
        "name": "reembody",
        "version": __version__,
        "licenses": [{"license": {"id": "Apache-2.0"}}],
    }
    serial = uuid.uuid5(NAMESPACE, json.dumps(components, sort_keys=True))
    return {
        "bomFormat": "CycloneDX",
        "specVersion": "1.6",
        "serialNumber": f"urn:uuid:{serial}",
        "version": 1,
        "metadata": {"component": root},
        "components": components,
        "dependencies": _dependencies(depended),
    }


def _python() -> Iterator[Json]:
    """Yield the packages of requirements.lock, with the hashes that an installation must match."""
    part: Json | None = None
    for line in (REPOSITORY / "requirements.lock").read_text(encoding="utf-8").splitlines():
        if pinned := PINNED.match(line):
            if part is not None:
                yield part
            part = _component("pypi", pinned["name"], pinned["version"])
        elif part is not None and (hashed := HASHED.search(line)):
            part.setdefault("hashes", []).append({"alg": "SHA-256", "content": hashed["hash"]})
        elif part is not None and (by := BY.match(line)):
            part["needed_by"].append(f"pypi/{by['who']}" if by["who"] != "reembody" else "reembody")
    if part is not None:
        yield part


def _javascript() -> Iterator[Json]:
    """Yield the packages that go into the pages, without the tools that build them."""
    lock = json.loads((REPOSITORY / "frontend" / "package-lock.json").read_text(encoding="utf-8"))
    packages: Json = lock["packages"]
    needed = {
        name: {*part.get("dependencies", {}), *part.get("peerDependencies", {})}
        for name, part in packages.items()
    }
    in_pages = _needed_by_pages(packages)
    for path, part in sorted(packages.items()):
        if path not in in_pages or part.get("dev") or part.get("optional"):
            continue
        name = path.rpartition("node_modules/")[2]
        made = _component("npm", name, part["version"])
        for other, names in needed.items():
            if name in names:
                by = other.rpartition("node_modules/")[2]
                made["needed_by"].append(f"npm/{by}" if by else "reembody")
        yield made


def _needed_by_pages(packages: Json) -> set[str]:
    """Return the paths of the packages that the pages import, directly or indirectly."""
    found: set[str] = set()
    names = [name for name in packages[""]["dependencies"] if name not in BUILD_TOOLS]
    while names:
        name = names.pop()
        for path in packages.keys() - found:
            if path.endswith(f"node_modules/{name}"):
                found.add(path)
                part = packages[path]
                names += [*part.get("dependencies", {}), *part.get("peerDependencies", {})]
    return found


def _component(kind: str, name: str, version: str) -> Json:
    return {
        "type": "library",
        "bom-ref": f"{kind}/{name}@{version}",
        "name": name,
        "version": version,
        "purl": f"pkg:{kind}/{name.replace('@', '%40')}@{version}",
        "needed_by": [],
    }


def _dependencies(depended: dict[str, list[str]]) -> list[Json]:
    """Return the dependencies of each package, from the users of each package."""
    known = {ref.rpartition("@")[0]: ref for ref in depended} | {"reembody": "reembody"}
    needs: dict[str, set[str]] = {"reembody": set()}
    for ref, users in depended.items():
        for user in users:
            if user in known:
                needs.setdefault(known[user], set()).add(ref)
    return [{"ref": ref, "dependsOn": sorted(parts)} for ref, parts in sorted(needs.items())]


if __name__ == "__main__":
    json.dump(bill_of_materials(), sys.stdout, indent=1, ensure_ascii=False)
    sys.stdout.write("\n")
