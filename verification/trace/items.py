"""What spec/requirements says, as StrictDoc exports it: items with fields and relations to their parents."""

import hashlib
import json
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

STRUCTURE = frozenset({"SECTION", "TEXT"})
"""Node types that order a document and are no items of the trace."""
GENERATED = frozenset({"UNIT", "RESULT"})
"""Node types that are written from sources and evidence; nobody reviews their text."""


@dataclass(frozen=True)
class Item:
    """One node of a document: a hazard, a requirement, a property and so on (`kind`, as in grammar.sgra)."""

    uid: str
    kind: str
    document: str
    fields: Mapping[str, str]
    parents: tuple[tuple[str, str], ...]
    """Role and UID of each parent, in the order of the document."""

    @property
    def title(self) -> str:
        return self.fields["TITLE"]

    @property
    def statement(self) -> str:
        return self.fields["STATEMENT"]

    def parents_by(self, *roles: str) -> list[str]:
        """UIDs of the parents with one of these roles; with no role, of all."""
        return [uid for role, uid in self.parents if not roles or role in roles]


class Items:
    """All items by UID, in the order of the documents, with their children, and the prose beside them."""

    def __init__(self, items: Iterable[Item], prose: Iterable[Item] = ()) -> None:
        self.prose = tuple(prose)
        self.by_uid: dict[str, Item] = {}
        for item in items:
            if item.uid in self.by_uid:
                raise ValueError(
                    f"{item.uid} stands twice: in {self.by_uid[item.uid].document} and {item.document}"
                )
            self.by_uid[item.uid] = item
        self.child_uids: dict[str, list[tuple[str, str]]] = {}
        for item in self.by_uid.values():
            for role, parent in item.parents:
                self.child_uids.setdefault(parent, []).append((role, item.uid))

    def __iter__(self) -> Iterator[Item]:
        return iter(self.by_uid.values())

    def __getitem__(self, uid: str) -> Item:
        return self.by_uid[uid]

    def of(self, *kinds: str) -> list[Item]:
        """The items of these kinds."""
        return [item for item in self if item.kind in kinds]

    def to_review(self) -> dict[str, Item]:
        """What somebody has to have read, by UID: items that nobody generates, and prose of documents."""
        return {one.uid: one for one in (*self, *self.prose) if one.kind not in GENERATED}

    def children(self, uid: str, *roles: str) -> list[Item]:
        """The items that name `uid` as parent, in one of these roles where roles are given."""
        return [self[child] for role, child in self.child_uids.get(uid, []) if not roles or role in roles]


def read_items(export: Path) -> Items:
    """The items of StrictDoc's JSON export (index.json).

    Raises ValueError for a node without UID and for a UID given twice.
    """

    def nodes(parent: Mapping, document: str) -> Iterator[Item]:
        for node in parent.get("NODES", []):
            kind = node["_NODE_TYPE"]
            if kind not in STRUCTURE:
                if "UID" not in node:
                    raise ValueError(f"{document}: a {kind} without UID: '{node.get('TITLE', '')}'")
                fields = {name: text.strip() for name, text in node.items() if isinstance(text, str)}
                relations = [one for one in node.get("RELATIONS", []) if one["TYPE"] == "Parent"]
                parents = tuple((one.get("ROLE", ""), one["VALUE"]) for one in relations)
                yield Item(node["UID"], kind, document, fields, parents)
            yield from nodes(node, document)

    documents = json.loads(export.read_text("utf-8"))["DOCUMENTS"]
    items = [item for document in documents for item in nodes(document, document["TITLE"])]
    prose = [prose_of(document) for document in documents if "UID" in document]
    return Items(items, [one for one in prose if one.statement])


def prose_of(document: Mapping) -> Item:
    """The text of a document that stands in no item (method, plans, tables), under the document's UID."""

    def texts(parent: Mapping) -> Iterator[str]:
        for node in parent.get("NODES", []):
            if node["_NODE_TYPE"] in STRUCTURE:
                yield (node.get("STATEMENT") or node.get("TITLE", "")).strip()
            yield from texts(node)

    fields = {"TITLE": document["TITLE"], "STATEMENT": "\n\n".join(texts(document))}
    return Item(document["UID"], "PROSE", document["TITLE"], fields, ())


def fingerprint(items: Items, item: Item) -> str:
    """A hash of what an item says and of what its parents say: a change of either asks for a new review."""

    def words(one: Item) -> str:
        said = {name: text for name, text in one.fields.items() if not name.startswith("_")}
        return json.dumps([one.kind, said, one.parents], sort_keys=True)

    parents = [words(items[uid]) for uid in item.parents_by() if uid in items.by_uid]
    return hashlib.sha256("\n".join([words(item), *parents]).encode()).hexdigest()[:16]
