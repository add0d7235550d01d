"""Whatever is sent, the answer is one that spec/openapi.yaml describes, and never a failure of the app."""

import pytest
import schemathesis
from hypothesis import HealthCheck, given, settings
from interface import spec
from schemathesis.checks import load_all_checks
from schemathesis.generation import GenerationMode
from schemathesis.specs.openapi.checks import (
    content_type_conformance,
    negative_data_rejection,
    response_schema_conformance,
    status_code_conformance,
)
from stack import Stack

EXAMPLES = 25
# The stream is no HTTP exchange, and the session of these tests has to last.
LEFT_OUT = {"stream", "logout", "endSession"}
# Those of the table in `info.description`, which every path can answer.
COMMON = ("403", "404", "405", "400")

load_all_checks()


def load() -> schemathesis.schemas.BaseSchema:
    described = spec()
    for methods in described["paths"].values():
        for method, operation in methods.items():
            if method == "parameters":
                continue
            for status in COMMON:
                operation["responses"].setdefault(status, {"$ref": "#/components/responses/NotFound"})
    return schemathesis.openapi.from_dict(described)


SCHEMA = load()
OPERATIONS = [
    pytest.param(operation, id=operation.label)
    for operation in (result.ok() for result in SCHEMA.get_all_operations())
    if operation.definition.raw["operationId"] not in LEFT_OUT
]


def takes_anything(operation: schemathesis.APIOperation) -> bool:
    """Whether there is something in it that can be wrong; in a path any text is right or nothing."""
    return bool(list(operation.body) or list(operation.query))


@pytest.mark.parametrize("operation", OPERATIONS)
def test_every_answer_is_described(robot: Stack, operation: schemathesis.APIOperation) -> None:
    ask_at_random(robot, operation, GenerationMode.POSITIVE)


@pytest.mark.parametrize("operation", [each for each in OPERATIONS if takes_anything(each.values[0])])
def test_every_answer_to_what_does_not_fit_is_described(
    robot: Stack, operation: schemathesis.APIOperation
) -> None:
    ask_at_random(robot, operation, GenerationMode.NEGATIVE)


def ask_at_random(robot: Stack, operation: schemathesis.APIOperation, mode: GenerationMode) -> None:
    cookie = "; ".join(f"{name}={value}" for name, value in robot.api.cookies.items())

    @settings(
        max_examples=EXAMPLES,
        derandomize=True,
        deadline=None,
        database=None,
        suppress_health_check=list(HealthCheck),
    )
    @given(case=operation.as_strategy(mode))
    def ask(case: schemathesis.Case) -> None:
        response = case.call(base_url=robot.url, headers={"Cookie": cookie})
        # On a busy machine it may have waited for more than a second for its record.
        late = response.status_code == 503 and response.json()["code"] == "LATE"
        assert response.status_code < 500 or late, response.text
        if response.status_code == 413:
            # As every path does with a body above 64 KiB, before anything of it is read.
            assert response.json()["code"] == "TOO_LARGE"
            assert len(response.request.body or b"") > 65536
            return
        case.validate_response(
            response,
            checks=[
                status_code_conformance,
                content_type_conformance,
                response_schema_conformance,
                negative_data_rejection,
            ],
        )

    ask()
    assert robot.status()["connected"]
