"""The examples in the stubs, and whether stubs and modules are complete."""

import ast
import doctest
import importlib
from pathlib import Path

import kinefront
import numpy as np
import pytest

STUBS = Path(__file__).resolve().parents[1] / "package/kinefront/_kinefront.pyi"


def test_the_examples_of_the_stubs_hold():
    documented = (ast.ClassDef, ast.FunctionDef)
    texts = [ast.get_docstring(node) or "" for node in ast.walk(ast.parse(STUBS.read_text())) if isinstance(node, documented)]
    runner = doctest.DocTestRunner()
    for text in texts:
        names = {**vars(kinefront), "kinefront": kinefront, "np": np}
        runner.run(doctest.DocTestParser().get_doctest(text, names, STUBS.name, str(STUBS), 0))
    assert runner.tries > 8 and runner.failures == 0


@pytest.mark.parametrize("name", ["sweeps", "pymoo", "optuna", "dask", "rerun"])
def test_every_public_name_of_a_module_is_documented(name):
    module = importlib.import_module(f"kinefront.{name}")
    public = [value for key, value in vars(module).items() if not key.startswith("_") and getattr(value, "__module__", "") == module.__name__]
    assert module.__doc__ and all(value.__doc__ for value in public)


def test_the_stubs_name_what_the_native_classes_have():
    text = STUBS.read_text()
    for name in ["Study", "Design", "Table", "Progress", "Run"]:
        native = getattr(kinefront, name)
        body = text.split(f"\nclass {name}:")[1].split("\nclass ")[0]
        for member in vars(native):
            if not member.startswith("_"):
                assert f"def {member}(" in body or f"    {member}:" in body, f"{name}.{member} is not in the stubs"
