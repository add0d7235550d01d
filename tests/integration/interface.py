"""spec/openapi.yaml as a judge: every answer must be one that the interface describes."""

import re
from functools import cache
from pathlib import Path

import httpx
import jsonschema
import yaml

SPEC = Path(__file__).resolve().parents[2] / "spec/openapi.yaml"
METHODS = {"get", "post", "put", "patch", "delete"}
# Those of the table in `info.description`, which every path can answer.
COMMON = {400, 401, 403, 404, 405, 413, 431, 500, 503}


@cache
def spec() -> dict:
    return yaml.load(SPEC.read_text(), Loader=yaml.CSafeLoader)


def paths() -> dict[str, dict]:
    """Operations by path and method."""
    return {
        path: {method: operation for method, operation in item.items() if method in METHODS}
        for path, item in spec()["paths"].items()
    }


def path_of(target: str) -> str:
    """The path of the interface that describes this target."""
    bare = target.partition("?")[0]
    for path in paths():
        if re.fullmatch(re.sub(r"\{\w+\}", "[^/]+", path), bare):
            return path
    raise AssertionError(f"{target} is not described")


def resolved(node: dict) -> dict:
    while "$ref" in node:
        place = spec()
        for key in node["$ref"].removeprefix("#/").split("/"):
            place = place[key]
        node = place
    return node


def judge(answer: httpx.Response) -> httpx.Response:
    """The answer, which must be described: status, content type and every field of its body."""
    where = f"{answer.request.method} {answer.request.url.path} -> {answer.status_code}"
    operation = paths()[path_of(answer.request.url.path)].get(answer.request.method.lower(), {})
    described = operation.get("responses", {}).get(str(answer.status_code))
    if described is None:
        assert answer.status_code in COMMON, f"{where} is not described"
        described = {"$ref": "#/components/responses/NotFound"}
    [(content_type, content)] = resolved(described)["content"].items()
    if content_type in ("text/plain", "text/csv"):
        assert answer.headers["content-type"].partition(";")[0] == content_type, where
        return answer
    assert answer.headers["content-type"] == content_type, where
    known = {"components": spec()["components"], **closed(content["schema"])}
    jsonschema.Draft202012Validator(known).validate(answer.json())
    return answer


def closed(schema: dict) -> dict:
    """A schema that also refuses fields which the interface does not name."""
    target = resolved(schema)
    if target.get("type") == "array":
        return {"type": "array", "items": closed(target["items"])}
    return {**target, "unevaluatedProperties": False} if "properties" in target else target
