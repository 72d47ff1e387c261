"""The notebook of the lecture runs from a clean kernel, and draws."""

import pathlib

import pytest

nbclient = pytest.importorskip("nbclient", reason="nbclient, which runs notebooks, is not installed")
pytest.importorskip("matplotlib", reason="Matplotlib is not installed")
nbformat = pytest.importorskip("nbformat")

NOTEBOOK = pathlib.Path(__file__).resolve().parents[2] / "examples" / "lecture.ipynb"


def test_the_lecture_runs():
    notebook = nbformat.read(NOTEBOOK, 4)
    assert not any(cell.get("outputs") for cell in notebook.cells), "the outputs are not kept in the repository"
    nbclient.NotebookClient(notebook, timeout=600, kernel_name="python3").execute()
    code = [cell for cell in notebook.cells if cell.cell_type == "code"]
    pictures = [cell for cell in code if any("image/png" in output.get("data", {}) for output in cell.outputs)]
    text = "".join(output.get("text", "") for cell in code for output in cell.outputs)
    assert len(pictures) >= len(code) - 1  # the last one needs PyTorch
    assert "J = 4 gives 3.224" in text
