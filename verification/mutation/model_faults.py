"""The faults of the model: its wrong variants, and what rung 1 said of each.

Rung 1 refutes every one of them on each run. What is told here comes from the logs of its last run, and only
where the modules and the configuration that it was given are those of the tree as it is.
"""

import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "model"))

import evidence
import tlc

from models import Model, WrongVariant, read_models, read_wrong_variants

NOT_ASKED = "not asked"
UNNOTICED = "-"


@dataclass(frozen=True)
class ModelFault:
    """A wrong variant, and the property that refuted it: UNNOTICED when none did, NOT_ASKED without a run."""

    name: str
    told: str


def was_asked(model: Model, variant: WrongVariant, folder: Path) -> bool:
    """Whether the last run in this folder was about the variant as it is, and came to an end."""
    if not (folder / "tlc.log").is_file():
        return False
    if (folder / "check.cfg").read_text("utf-8") != model.configuration([variant.property]):
        return False
    for module in tlc.SPECIFICATION.glob("*.tla"):
        text = module.read_text("utf-8")
        for edit in variant.edits:
            text = text.replace(edit.old, edit.new) if edit.module == module.stem else text
        copy = folder / module.name
        if not copy.is_file() or copy.read_text("utf-8") != text:
            return False
    return "Finished in" in (folder / "tlc.log").read_text("utf-8", "replace")


def verdict_on(model: Model, variant: WrongVariant) -> ModelFault:
    """What rung 1 said of one wrong variant."""
    folder = evidence.EVIDENCE / "model" / model.name / f"wrong-{variant.name}"
    told = NOT_ASKED
    if was_asked(model, variant, folder):
        answer = tlc.Answer(0, (folder / "tlc.log").read_text("utf-8", "replace"), 0.0)
        told = variant.property if answer.refutes(variant.property) else UNNOTICED
    return ModelFault(variant.name, told)


def model_faults() -> Iterator[ModelFault]:
    """All wrong variants."""
    by_name = {model.name: model for model in read_models()}
    for variant in read_wrong_variants(set(by_name)):
        yield verdict_on(by_name[variant.model], variant)
