# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""Writes type stubs with docstrings for wrapped modules.

    make_stubs.py PACKAGE FOLDER MODULE ...

VTK's own generate_pyi writes neither docstrings nor types of properties, and some builds lack it. As it
does, this reads signatures from the docstrings that VTK's wrapping makes, such as

    SetSlabCenter(self, x:float, y:float, z:float) -> None
    C++: virtual void SetSlabCenter(double x, double y, double z)
"""

import ast
import importlib
import inspect
import keyword
import pathlib
import re
import sys
import textwrap

HEADER = """\
from collections.abc import Callable, MutableSequence, Sequence
from typing import Any, overload
"""
BUILTIN = {"bool", "bytes", "float", "int", "object", "str", "None"}
OTHERS = {"Callback": "Callable[..., None] | None", "Buffer": "Any", "Pointer": "Any", "Template": "Any"}


class Stubs:
    """The stub of one module."""

    def __init__(self, module):
        self.module = module
        self.imports = set()
        classes = [
            value
            for name, value in sorted(vars(module).items())
            if inspect.isclass(value) and value.__module__.endswith(module.__name__.split(".")[-1])
        ]
        body = "\n\n".join(self.class_text(one) for one in classes)
        imports = "".join(f"import {name}\n" for name in sorted(self.imports))
        self.text = f"{HEADER}\n{imports}\n{body}\n"

    def name_of_class(self, one):
        if one.__module__ in ("builtins", self.module.__name__):
            return one.__name__
        self.imports.add(one.__module__)
        return f"{one.__module__}.{one.__qualname__}"

    def name_of_type(self, name):
        """Any stands for classes of modules that are not loaded."""
        if name in BUILTIN:
            return name
        if name in OTHERS:
            return OTHERS[name]
        package = self.module.__name__.split(".")[0]
        for module in list(sys.modules.values()):
            one = getattr(module, "__dict__", {}).get(name.split(".")[0])
            if inspect.isclass(one) and (one.__module__.startswith((package, VTK_PACKAGE))):
                return self.name_of_class(one)
        return "Any"

    def annotation(self, node, returned):
        if isinstance(node, ast.Constant):
            return repr(node.value)
        if isinstance(node, (ast.Name, ast.Attribute)):
            return self.name_of_type(ast.unparse(node))
        if isinstance(node, (ast.Tuple, ast.List)) and node.elts:
            element = self.annotation(node.elts[0], returned)
            if not returned:
                kind = "Sequence" if isinstance(node, ast.Tuple) else "MutableSequence"
                return f"{kind}[{element}]"
            return f"tuple[{', '.join([element] * len(node.elts))}]"
        return "Any"

    def signatures(self, method):
        """The definitions in a method's docstring, whose long lines go on after an indent."""
        paragraph = re.sub(r"\n[ \t]+", " ", (method.__doc__ or "").split("\n\n")[0])
        found = []
        for line in paragraph.splitlines():
            if line.startswith(f"{method.__name__}("):
                definition = ast.parse(f"def {line}: ...").body[0]
                found.append(self.definition(definition))
        return list(dict.fromkeys(found))

    def definition(self, node):
        names, static = [], "@staticmethod\n"
        for argument in node.args.args:
            if argument.arg == "self":
                names.append("self")
                static = ""
                continue
            name = argument.arg.strip("_")
            while keyword.iskeyword(name) or any(other.split(":")[0] == name for other in names):
                name += "_"
            names.append(f"{name}: {self.annotation(argument.annotation, False)}")
        # VTK's wrappers take no names of arguments.
        arguments = ", ".join([*names, "/"] if names != ["self"] and names else names)
        returns = self.annotation(node.returns, True) if node.returns else "None"
        return f"{static}def {node.name}({arguments}) -> {returns}:"

    def method_text(self, method):
        signatures = self.signatures(method)
        text = "\n\n".join((method.__doc__ or "").split("\n\n")[1:])
        doc = docstring(text) or "..."
        many = "@overload\n" if len(signatures) > 1 else ""
        return "\n".join(
            f"{many}{signature}\n{textwrap.indent(doc if n == 0 else '...', '    ')}"
            for n, signature in enumerate(signatures)
        )

    def property_text(self, name, value, owner):
        """A property has the type that its getter returns."""
        getter = getattr(owner, "Get" + "".join(part.capitalize() for part in name.split("_")), None)
        signatures = self.signatures(getter) if getter else []
        kind = signatures[0].split("-> ")[1].rstrip(":") if signatures else "Any"
        doc = textwrap.indent(docstring(value.__doc__) or "...", "    ")
        text = f"@property\ndef {name}(self) -> {kind}:\n{doc}"
        if "write" in (value.__doc__ or ""):
            text += f"\n@{name}.setter\ndef {name}(self, value: Any) -> None: ..."
        return text

    def class_text(self, one):
        bases = ", ".join(self.name_of_class(base) for base in one.__bases__)
        parts = [docstring(one.__doc__)]
        if not issubclass(one, int):
            parts.append("def __init__(self, **properties: Any) -> None: ...")
        for name, value in vars(one).items():
            if name.startswith("__") or keyword.iskeyword(name):
                continue
            if inspect.isclass(value):
                parts.append(self.class_text(value))
            elif inspect.isgetsetdescriptor(value):
                parts.append(self.property_text(name, value, one))
            elif callable(value):
                parts.append(self.method_text(value))
            else:
                parts.append(f"{name}: {type(value).__name__ if type(value) in (int, float, str) else 'int'}")
        body = "\n".join(part for part in parts if part) or "..."
        return f"class {one.__name__}({bases}):\n{textwrap.indent(body, '    ')}"


def docstring(text):
    text = inspect.cleandoc(text or "").replace("\\", "\\\\").replace('"""', "'''")
    return f'"""{text}\n"""' if text else ""


if __name__ == "__main__":
    package = importlib.import_module(sys.argv[1])
    VTK_PACKAGE = package.vtkVersion.__module__.split(".")[0]
    for name in package.__all__:
        getattr(package, name)
    for name in sys.argv[3:]:
        stubs = Stubs(importlib.import_module(f"{package.__name__}.{name}"))
        pathlib.Path(sys.argv[2], f"{name}.pyi").write_text(stubs.text, encoding="utf-8")
