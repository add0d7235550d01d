"""The HTTP reference as Markdown, from spec/openapi.yaml: every operation, schema and word of the stream."""

from collections.abc import Iterator, Mapping, Sequence

METHODS = ("get", "put", "post", "patch", "delete")


def cell(text: object) -> str:
    """A text in a cell of a table."""
    return " ".join(str(text).split()).replace("|", "\\|")


def table(head: Sequence[str], rows: Sequence[Sequence[object]]) -> str:
    """A table, or nothing without rows."""
    if not rows:
        return ""
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(cell(one) for one in line) + " |" for line in lines) + "\n"


def type_of(schema: Mapping) -> str:
    """A schema in a few words; a named one, or the part of one, by its name, which leads to it."""
    if "$ref" in schema:
        name, *part = schema["$ref"].split("/")[3:]
        link = f"[{name}](#schema-{name.lower()})"
        return f"`{part[-1]}` of {link}" if part else link
    for joined, word in (("oneOf", " or "), ("anyOf", " or "), ("allOf", " and ")):
        if joined in schema:
            return word.join(type_of(one) for one in schema[joined])
    if "const" in schema:
        return f"`{schema['const']}`"
    if "enum" in schema:
        return ", ".join(f"`{one}`" for one in schema["enum"])
    kinds = schema.get("type", "any")
    kind = " or ".join(kinds) if isinstance(kinds, list) else str(kinds)
    if kind.startswith("array"):
        return f"array of {type_of(schema.get('items', {}))}"
    ends = [f"{name} {schema[key]}" for name, key in LIMITS if key in schema]
    return ", ".join([kind, *ends])


LIMITS = (
    ("at least", "minimum"),
    ("at most", "maximum"),
    ("above", "exclusiveMinimum"),
    ("below", "exclusiveMaximum"),
    ("no shorter than", "minLength"),
    ("no longer than", "maxLength"),
)


def resolved(document: Mapping, entry: Mapping) -> Mapping:
    """An entry, or what it refers to."""
    found: Mapping = document
    if "$ref" not in entry:
        return entry
    for part in entry["$ref"].removeprefix("#/").split("/"):
        found = found[part]
    return found


def bodies(content: Mapping) -> str:
    """What a body may be, by its media type."""
    return "; ".join(f"{media}: {type_of(one.get('schema', {}))}" for media, one in content.items())


def operation(document: Mapping, path: str, method: str, shared: Sequence[Mapping]) -> Iterator[str]:
    """One operation: who may use it, what it takes and what it answers."""
    stated = document["paths"][path][method]
    yield f"## {method.upper()} {path}\n"
    control = ", in control" if stated.get("x-control") else ""
    yield f"{stated['summary'].strip()}\n"
    if "description" in stated:
        yield f"{stated['description'].strip()}\n"
    yield f"Role: **{stated['x-role']}**{control}.\n"
    parameters = [resolved(document, one) for one in (*shared, *stated.get("parameters", ()))]
    yield table(
        ("parameter", "in", "type", "means"),
        [
            (f"`{one['name']}`", one["in"], type_of(one["schema"]), one.get("description", ""))
            for one in parameters
        ],
    )
    if "requestBody" in stated:
        body = resolved(document, stated["requestBody"])
        yield f"Body: {bodies(body['content'])}\n"
    answers = [(code, resolved(document, one)) for code, one in stated["responses"].items()]
    yield table(
        ("status", "means", "body"),
        [(code, one.get("description", ""), bodies(one.get("content", {}))) for code, one in answers],
    )


def schema_page(name: str, schema: Mapping) -> Iterator[str]:
    """One schema with its fields."""
    yield f"(schema-{name.lower()})=\n## Schema {name}\n"
    if "description" in schema:
        yield f"{schema['description'].strip()}\n"
    required = set(schema.get("required", ()))
    fields = schema.get("properties", {})
    if not fields:
        yield f"{type_of(schema)}\n"
    yield table(
        ("field", "type", "required", "means"),
        [
            (f"`{field}`", type_of(one), "yes" if field in required else "no", one.get("description", ""))
            for field, one in fields.items()
        ],
    )


def stream(document: Mapping) -> Iterator[str]:
    """The stream's binary message, word by word, and its text messages."""
    stated = document["components"]["x-stream"]
    yield f"## The stream\n\n{stated['description']}\n"
    for part in ("header", "slot"):
        yield f"### Words of each {part}\n"
        words = [
            (
                number,
                f"`{one['name']}`",
                "signed" if one.get("signed") else "unsigned",
                one.get("description", one.get("value", "")),
            )
            for number, one in enumerate(stated[part])
        ]
        yield table(("word", "name", "sign", "means"), words)
    yield f"### State\n\n{stated['state_words']} words. {stated['state']}\n"
    yield f"### Text messages\n\n{stated['text']}\n"


def http_page(document: Mapping) -> str:
    """The whole reference."""
    lines = ["# HTTP reference\n", f"{document['info']['description']}\n"]
    for path, item in document["paths"].items():
        for method in METHODS:
            if method in item:
                lines += operation(document, path, method, item.get("parameters", ()))
    lines += stream(document)
    for name, schema in document["components"]["schemas"].items():
        lines += schema_page(name, schema)
    return "\n".join(line for line in lines if line)
