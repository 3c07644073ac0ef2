"""One page with the help of every command, as the program prints it."""

import re
import subprocess


def help_of(program, *words):
    printed = subprocess.run([str(program), *words, "--help"], capture_output=True, text=True, check=True)
    return printed.stdout.rstrip()


def commands_of(text):
    """The names below `Commands:` in a help."""
    found = re.search(r"^Commands:\n((?: +\S.*\n?|\n(?= ))+)", text, re.M)
    return [name for name in re.findall(r"^  ([a-z][a-z-]*)", found[1], re.M) if name != "help"] if found else []


def write(program, folder):
    """Writes the page; its name."""
    text = help_of(program)
    lines = ["# Commands", "", "Made of what the program prints with `--help`.", "", "```text", text, "```"]
    waiting = [(name,) for name in commands_of(text)]
    while waiting:
        words = waiting.pop(0)
        text = help_of(program, *words)
        lines += ["", f"## gearmesh {' '.join(words)}", "", "```text", text, "```"]
        waiting[:0] = [(*words, name) for name in commands_of(text)]
    (folder / "commands.md").write_text("\n".join(lines) + "\n")
    return "commands.md"
