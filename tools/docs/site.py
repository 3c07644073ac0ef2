"""The documentation as one site that opens without a network and without a server.

    python tools/docs/site.py PROGRAM OUTPUT

`cargo xtask docs` calls it. Pages are those of docs/ and README.md as they are; beside them stand the help of every command
(from PROGRAM), and the functions of the Python package (from its sources). The map docs/README.md is the navigation. A link
that leads nowhere, of a page or to a heading, is an error.
"""

import logging
import re
import shutil
import sys
from pathlib import Path

import mkdocs.commands.build
import mkdocs.config

import command_pages
import notebook_pages
import python_pages
import staging

HERE = Path(__file__).parent
ROOT = HERE.parents[1]


def github_anchor(title, separator):
    """The anchor of a heading as the links of the pages have it: lower case, blanks to hyphens, punctuation gone."""
    kept = "".join(letter for letter in title.lower() if letter.isalnum() or letter in " -_")
    return kept.strip().replace(" ", separator)


def made_pages(program, folder):
    """Pages that are made of the program and of the package; their titles and names."""
    made = {"Commands": command_pages.write(program, folder), "Python package": python_pages.write(ROOT, folder)}
    notebook_pages.write(ROOT / "docs/notebooks", folder / "notebooks")
    return made


def navigation(map_page, made):
    """The sections of the map and the pages that it links, each once."""
    found, seen, section = [], {"index.md"}, None
    for line in map_page.splitlines():
        if line.startswith("## "):
            section = []
            found.append({line[3:]: section})
        for title, page in re.findall(r"\[([^\]]+)\]\(([^)#]+\.(?:md|ipynb))[^)]*\)", line):
            page = page.replace("../", "repository/").replace(".ipynb", ".md")
            if section is not None and page not in seen:
                seen.add(page)
                words = title.removesuffix(".md").removesuffix(".ipynb").split("/")[-1].replace("_", " ").replace("-", " ")
                section.append({words[0].upper() + words[1:]: page})
    look_up = next(section["Look up"] for section in found if "Look up" in section)
    look_up[:0] = [{title: page} for title, page in made.items()]
    return [{"Start": "index.md"}, *found]


def build(program, output):
    pages = output.parent / "pages"
    for folder in (pages, output):
        shutil.rmtree(folder, ignore_errors=True)
    pages.mkdir(parents=True)
    staging.copy(ROOT, pages)
    made = made_pages(program, pages)
    config = mkdocs.config.load_config(
        config_file_path=str(pages.parent / "mkdocs.yml"),
        config_file=(HERE / "mkdocs.yml").open("rb"),
        docs_dir=str(pages),
        site_dir=str(output),
        nav=navigation((ROOT / "docs/README.md").read_text(), made),
        theme={"name": "mkdocs", "custom_dir": str(HERE / "theme"), "color_mode": "auto", "user_color_mode_toggle": True, "highlightjs": False, "nav_style": "dark"},
        markdown_extensions=["tables", "fenced_code", "sane_lists", {"codehilite": {"css_class": "highlight", "guess_lang": False}}, {"toc": {"slugify": github_anchor}}],
        strict=True,
    )
    mkdocs.commands.build.build(config)
    staging.index_as_script(output)
    return sum(1 for _ in output.rglob("*.html"))


if __name__ == "__main__":
    logging.basicConfig(level=logging.WARNING, format="%(levelname)s: %(message)s")
    program, output = Path(sys.argv[1]), Path(sys.argv[2]).absolute()
    print(f"{build(program, output)} pages: {output / 'index.html'}")
