"""Types and docstrings say what there is."""

import ast
import inspect
from pathlib import Path

import pytest
import tendon_leg
from tendon_leg import _native

STUB = ast.parse((Path(tendon_leg.__file__).parent / "_native.pyi").read_text())


def functions(body):
    return {node.name: node for node in body if isinstance(node, ast.FunctionDef)}


def arguments(node):
    """Name, kind and default of each, but for `self` and `cls`."""
    names = [(each.arg, "free") for each in node.args.args if each.arg not in ("self", "cls")]
    defaults = [ast.literal_eval(each) for each in node.args.defaults]
    given = [None] * (len(names) - len(defaults)) + [(each,) for each in defaults]
    keyword = [(each.arg, "keyword") for each in node.args.kwonlyargs]
    given += [(ast.literal_eval(each),) for each in node.args.kw_defaults]
    return [(*name, default) for name, default in zip(names + keyword, given, strict=True)]


def real_arguments(callable_):
    kinds = {inspect.Parameter.KEYWORD_ONLY: "keyword"}
    found = inspect.signature(callable_).parameters.values()
    return [
        (each.name, kinds.get(each.kind, "free"), None if each.default is each.empty else (each.default,))
        for each in found
        if each.name != "self"
    ]


def test_the_stub_has_every_name_and_no_other():
    stubbed = {node.target.id for node in STUB.body if isinstance(node, ast.AnnAssign)}
    stubbed |= {node.name for node in STUB.body if isinstance(node, ast.FunctionDef | ast.ClassDef)}
    real = {name for name in dir(_native) if not name.startswith("__")}
    assert stubbed == real
    own = {name for name in dir(tendon_leg.errors) if name[0].isupper()} | {"AsyncLeg", "campaign"}
    assert set(tendon_leg.__all__) == real | own


def stubbed():
    """Each class, method, property and function of the stub with its words."""
    for node in STUB.body:
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            yield node.name, node
        if isinstance(node, ast.ClassDef):
            # What a constructor takes stands with its class; what `==` and `hash` are, everybody knows.
            silent = ("__new__", "__hash__", "__eq__", "__reduce__")
            yield from ((f"{node.name}.{name}", each) for name, each in functions(node.body).items() if name not in silent)


@pytest.mark.parametrize(("name", "node"), list(stubbed()), ids=[name for name, _ in stubbed()])
def test_help_says_what_the_stub_says(name, node):
    real = _native
    for part in name.split("."):
        real = getattr(real, part)
    assert ast.get_docstring(node)
    assert ast.get_docstring(node) == inspect.getdoc(real)


def test_everything_public_has_its_words():
    for name in tendon_leg.__all__:
        each = getattr(tendon_leg, name)
        if not callable(each):
            continue
        assert inspect.getdoc(each), name
        own = vars(each) if isinstance(each, type) and not issubclass(each, Exception) else {}
        for member in own:
            if not member.startswith("_"):
                assert inspect.getdoc(getattr(each, member)), f"{name}.{member}"


def test_every_signature_is_that_of_the_stub():
    for node in STUB.body:
        if isinstance(node, ast.FunctionDef):
            assert arguments(node) == real_arguments(getattr(_native, node.name)), node.name
        if isinstance(node, ast.ClassDef):
            assert_class(node, getattr(_native, node.name))


def assert_class(node, class_):
    methods = functions(node.body)
    real = {name for name in vars(class_) if not name.startswith("_")}
    assert {name for name in methods if not name.startswith("_")} == real
    if "__new__" in methods:
        assert arguments(methods["__new__"]) == real_arguments(class_)
    else:
        pytest.raises(TypeError, class_)
    for name, method in methods.items():
        if not name.startswith("__") and not method.decorator_list:
            assert arguments(method) == real_arguments(getattr(class_, name)), name
