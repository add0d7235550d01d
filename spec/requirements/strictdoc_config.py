"""How StrictDoc shows the documents of build/report/source, with the sources that they name."""

from pathlib import Path

from strictdoc.core.project_config import ProjectConfig

ROOT = Path(__file__).resolve().parents[2]


def create_config() -> ProjectConfig:
    return ProjectConfig(
        project_title="Interlock",
        source_root_path=str(ROOT),
        dir_for_sdoc_cache=str(ROOT / "build/report/cache"),
        project_features=["REQUIREMENT_TO_SOURCE_TRACEABILITY", "SEARCH"],
        include_source_paths=[
            "kernel/src/*.c",
            "kernel/src/*.h",
            "spec/tla/*.tla",
            "verification/tick/*.c",
            "verification/cbmc/**/harness.c",
        ],
    )
