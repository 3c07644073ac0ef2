"""One page with the classes and functions of the Python package, from its sources and stubs; nothing is imported."""

import ast
import inspect


def signature(function):
    """`name(arguments) -> result` as the source has it."""
    result = f" -> {ast.unparse(function.returns)}" if function.returns else ""
    return f"{function.name}({ast.unparse(function.args)}){result}"


def words(node):
    return inspect.cleandoc(ast.get_docstring(node) or "")


def entry(level, title, code, text):
    """A heading, the signature, what is said of it. The text is shown as it is written: in lines."""
    lines = [f"{'#' * level} {title}", "", "```python", code, "```", ""]
    return lines + (["```text", text, "```", ""] if text else [])


def exported(package):
    """Names of the package, in its own order."""
    tree = ast.parse((package / "__init__.py").read_text())
    for node in tree.body:
        if isinstance(node, ast.Assign) and any(getattr(target, "id", "") == "__all__" for target in node.targets):
            return ast.literal_eval(node.value)
    raise SystemExit("gearmesh/__init__.py has no __all__")


def write(root, folder):
    """Writes the page; its name."""
    package = root / "crates/python/gearmesh"
    found = {}
    for file in sorted([*package.glob("*.py"), package / "_native.pyi"]):
        for node in ast.parse(file.read_text()).body:
            if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
                # What is written in Python says more than the stub of what it calls.
                found.setdefault(node.name, node)
    lines = ["# Python package", "", "Made of the sources and stubs of the package. The guide is [python.md](python.md).", ""]
    for name in exported(package):
        node = found.get(name)
        if isinstance(node, ast.FunctionDef):
            lines += entry(2, name, f"gearmesh.{signature(node)}", words(node))
        elif isinstance(node, ast.ClassDef):
            bases = ", ".join(ast.unparse(base) for base in node.bases)
            lines += entry(2, name, f"class gearmesh.{name}{f'({bases})' if bases else ''}", words(node))
            for method in node.body:
                if isinstance(method, ast.FunctionDef) and (method.name == "__init__" or not method.name.startswith("_")):
                    lines += entry(3, f"`{name}.{method.name}`", signature(method), words(method))
    (folder / "package.md").write_text("\n".join(lines) + "\n")
    return "package.md"
