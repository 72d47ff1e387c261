"""The stubs of the extensions agree with what is in them. (mypy.stubtest does not know nanobind's functions.)"""

import ast
import inspect
import pathlib

import pytest

import domelight as dl
from domelight import _batch, _core, _probes, _render

FOLDER = pathlib.Path(dl.__file__).parent


def stub_of(module):
    """Names of functions and classes, with the names of their parameters."""
    tree = ast.parse((FOLDER / f"{module.__name__.rpartition('.')[2]}.pyi").read_text())
    found = {}
    for node in tree.body:
        if isinstance(node, ast.FunctionDef):
            found[node.name] = [argument.arg for argument in node.args.args]
        if isinstance(node, ast.ClassDef):
            found[node.name] = sorted(member.name for member in node.body)
    return found


def names_of(function):
    signature = ast.parse(function.__nb_signature__[0][0].replace("\\", "_") + ": ...").body[0]
    return [argument.arg for argument in signature.args.args]


@pytest.mark.parametrize("module", [_batch, _core, _probes, _render])
def test_the_stub_has_what_the_module_has(module):
    there = {}
    for name, value in vars(module).items():
        if name.startswith("_"):
            continue
        if inspect.isclass(value):
            there[name] = sorted(member for member in vars(value) if not member.startswith("_"))
        else:
            there[name] = names_of(value)
    assert stub_of(module) == there


def test_everything_public_has_a_docstring_and_types():
    for name in dl.__all__:
        value = getattr(dl, name)
        assert inspect.getdoc(value), name
        if inspect.isfunction(value):
            assert "return" in value.__annotations__ and all(
                parameter.annotation is not parameter.empty for parameter in inspect.signature(value).parameters.values()
            ), name
    assert (FOLDER / "py.typed").exists()
