"""Notebooks as pages: their texts, their code, and the text that the code printed where the file has it."""

import json


def write(notebooks, folder):
    folder.mkdir(parents=True, exist_ok=True)
    for file in sorted(notebooks.glob("*.ipynb")):
        lines = []
        for cell in json.loads(file.read_text())["cells"]:
            source = "".join(cell["source"])
            lines += [source, ""] if cell["cell_type"] == "markdown" else ["```python", source, "```", ""]
            for output in cell.get("outputs", []):
                lines += ["```text", "".join(output["text"]).rstrip(), "```", ""] if "text" in output else []
        (folder / f"{file.stem}.md").write_text("\n".join(lines))
