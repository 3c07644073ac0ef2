"""The pages of the repository side by side, as the site has them."""

import json
import re
import shutil
from pathlib import Path

LINK = re.compile(r"(\]\()([^)\s]+)(\))")
CODE = re.compile(r"^\s*```")
# A list or a table begins without a blank line before it; the site's Markdown wants one.
ITEM = re.compile(r"^(?:[-*+] |\d+\. |\|)")


def copy(root, pages):
    """Copies docs/ and the pages beside it, with their links changed to where things stand in the site."""
    docs = root / "docs"
    for file in sorted(docs.rglob("*")):
        name = file.relative_to(docs)
        if not file.is_file() or file.suffix == ".ipynb":
            continue
        to = pages / ("index.md" if str(name) == "README.md" else name)
        to.parent.mkdir(parents=True, exist_ok=True)
        if file.suffix == ".md":
            to.write_text(page(file, to, root, pages))
        else:
            shutil.copy(file, to)
    for name in ("README.md", "CONTRIBUTING.md", "CHANGELOG.md"):
        to = pages / "repository" / name
        to.parent.mkdir(exist_ok=True)
        to.write_text(page(root / name, to, root, pages))


def page(file, to, root, pages):
    """The text of a page for its place in the site."""
    lines, in_code, before = [], False, ""
    for line in file.read_text().splitlines():
        if CODE.match(line):
            in_code = not in_code
        elif not in_code:
            if ITEM.match(line) and before.strip() and not ITEM.match(before) and not before.startswith(" "):
                lines.append("")
            line = LINK.sub(lambda found: found[1] + target(found[2], file, to, root, pages) + found[3], line)
        lines.append(line)
        before = line
    return "\n".join(lines) + "\n"


def target(link, file, to, root, pages):
    """Where a link of a page leads in the site. Files of the repository that are no pages are copied beside them."""
    path, _, heading = link.partition("#")
    if ":" in link or not path:
        return link
    wanted = (file.parent / path).resolve()
    docs = root / "docs"
    if wanted.is_relative_to(docs):
        place = pages / wanted.relative_to(docs)
        if wanted == docs / "README.md":
            place = pages / "index.md"
        elif wanted.suffix == ".ipynb":
            place = place.with_suffix(".md")
        elif wanted.is_dir():
            place = place / "index.md"
            if not place.exists():
                listing(wanted, place)
    elif wanted in (root / "README.md", root / "CONTRIBUTING.md", root / "CHANGELOG.md"):
        place = pages / "repository" / wanted.name
    else:
        place = pages / "repository" / wanted.relative_to(root)
        if wanted.is_dir():
            place = place / "index.md"
            place.parent.mkdir(parents=True, exist_ok=True)
            listing(wanted, place)
        elif wanted.suffix == ".md":
            place = place.with_name(f"{place.name}.txt")
        if wanted.is_file():
            place.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(wanted, place)
    return relative(place, to.parent) + (f"#{heading}" if heading else "")


def relative(place, folder):
    """A path from a folder, with / and .. as links have it."""
    import os

    return os.path.relpath(place, folder).replace("\\", "/")


def listing(folder, place):
    """A page that lists a folder; its pages as links."""
    place.parent.mkdir(parents=True, exist_ok=True)
    names = sorted(file.name for file in folder.iterdir() if not file.name.startswith("."))
    isolated = place.parent.name != folder.name or "repository" in place.parts
    lines = [f"- {name}" if isolated or not name.endswith(".md") else f"- [{name}]({name})" for name in names if name != "README.md"]
    place.write_text(f"# {folder.name}\n\n" + "\n".join(lines) + "\n")


def index_as_script(site):
    """A page that was opened as a file may not read another file; a script it may load."""
    index = json.loads((site / "search/search_index.json").read_text())
    (site / "search/search_index.js").write_text(f"var searchIndex = {json.dumps(index, separators=(',', ':'))};\n")
    for name in ("search_index.json", "worker.js", "lunr.js"):
        Path(site / "search" / name).unlink()
